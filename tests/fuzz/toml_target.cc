// TOML as parts, cells and campaigns are written in it: layers, grids, tables, overrides.

#include "models/base/config/config.h"
#include "models/part.h"
#include "tests/fuzz/byte_target.h"
#include "tests/fuzz/corpus_files.h"
#include "tests/fuzz/memory_file.h"

namespace tubetwin {

void TryBytes(std::string_view bytes) {
  const std::string text(bytes);
  const auto layer = [&text] {
    ConfigSource source;
    source.AddText(text, "f.toml");
    return source;
  };
  const auto read = [&] {
    Part part;
    layer().ReadInto(part);
    if (WriteToml([&part](ConfigVisitor& v) { part.Visit(v); }, false).empty()) {
      DieOf("TOML of a part", "nothing to write");
    }
  };
  TryReader("TOML of a part", "f.toml", read, {ErrorKind::kConfig});
  const auto expand = [&] {
    ConfigSource source = layer();
    for (ConfigSource& table : source.TakeTables("variant")) {
      ConfigSource keys = table.TakeTable("set");
      table.MoveKey("part", keys, "name");
      Part any;
      for (const ConfigSource& point :
           keys.ExpandLists([&any](ConfigVisitor& v) { any.Visit(v); })) {
        Part part;
        point.ReadInto(part);
      }
      table.Texts();
    }
  };
  TryReader("TOML of variants", "f.toml", expand, {ErrorKind::kConfig});
  if (text.find('\n') != std::string::npos) return;
  const auto override_part = [&] {
    ConfigSource source;
    source.AddOverride(text);
    Part part;
    source.ReadInto(part);
  };
  TryReader("--set", "--set", override_part, {ErrorKind::kConfig, ErrorKind::kUsage});
}

std::vector<std::string> ByteCorpus() { return CorpusFiles("toml"); }

}  // namespace tubetwin
