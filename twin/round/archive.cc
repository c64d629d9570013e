#include "twin/round/archive.h"

#include <filesystem>
#include <sstream>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/cell_model.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

constexpr char kToml[] = ".toml";

bool IsFile(const std::string& name_or_file) { return name_or_file.ends_with(kToml); }

class Archive {
 public:
  void Mesh(std::string& file, const std::string& name) {
    if (file.empty()) return;
    const std::string copy = name + fs::path(file).extension().string();
    files.push_back({copy, ReadFile(file)});
    file = copy;
  }
  void Part(std::string& name_or_file) {
    if (!IsFile(name_or_file)) return;
    files.push_back({"given.part.toml", ReadFile(name_or_file)});
    name_or_file = files.back().name;
  }
  void Cell(std::string& name_or_file) {
    if (!IsFile(name_or_file)) return;
    const CellFiles model = LoadCellModel(name_or_file).files;
    std::string cell = model.cell.text;
    const auto device = [&](const char* key, const ModelFile& file) {
      if (file.shipped) return;
      const std::string copy = std::string("given.") + key + kToml;
      files.push_back({copy, file.text});
      cell = WithDevice(cell, key, copy);
    };
    device("arm", model.arm);
    device("gripper", model.gripper);
    device("wrist", model.wrist);
    device("scanner", model.scanner);
    files.push_back({"given.cell.toml", cell});
    name_or_file = files.back().name;
  }

  std::vector<ArchivedFile> files;

 private:
  /// A cell file's text with another file for a device: the line of the key, which stands before
  /// the first table.
  static std::string WithDevice(const std::string& cell, const std::string& key,
                                const std::string& copy) {
    std::istringstream lines(cell);
    std::string out;
    bool done = false;
    for (std::string line; std::getline(lines, line);) {
      const auto begin = line.find_first_not_of(" \t\"'");
      const bool is_key =
          begin != std::string::npos && line.compare(begin, key.size(), key) == 0 &&
          line.find_first_of("=", begin) != std::string::npos &&
          line.find_first_not_of(" \t\"'", begin + key.size()) == line.find_first_of("=", begin);
      if (is_key && !done) {
        line = key + " = \"" + copy + "\"";
        done = true;
      }
      out += line + "\n";
    }
    TT_CHECK(done);
    return out;
  }
};

}  // namespace

std::vector<ArchivedFile> ArchiveInputs(Scenario& scenario) {
  Archive archive;
  archive.Mesh(scenario.bin.mesh, "given.bin");
  for (std::size_t i = 0; i < scenario.cell.arm.visual_meshes.size(); ++i) {
    archive.Mesh(scenario.cell.arm.visual_meshes[i], "given.arm_" + std::to_string(i));
  }
  archive.Part(scenario.pile.part);
  if (scenario.pile.part.empty()) archive.Part(scenario.part.name);
  archive.Cell(scenario.cell.model);
  return std::move(archive.files);
}

}  // namespace tubetwin
