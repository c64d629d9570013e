#include "hw_bridge/recording/recording_header.h"

#include <optional>

#include "models/base/error.h"
#include "models/base/json.h"
#include "models/base/json_text.h"

namespace tubetwin {
namespace {

constexpr const char* kSchema = "tubetwin/cell_recording/1";

Json PoseJson(const RigidTransform& X_AB) {
  return std::vector<double>(X_AB.matrix().data(), X_AB.matrix().data() + 16);
}

/// What configuration and calibration may change of a model's layout, and what recordings had
/// before they held the model.
Json LayoutJson(const CellLayout& layout) {
  return Json{{"X_FK", PoseJson(layout.X_FK)},     {"X_FE", PoseJson(layout.X_FE)},
              {"X_FS", PoseJson(layout.X_FS)},     {"X_BS", PoseJson(layout.X_BS)},
              {"X_BT", PoseJson(layout.X_BT)},     {"tray_size_m", layout.tray_size_m},
              {"tray_zone_m", layout.tray_zone_m}, {"slot_pitch_m", layout.slot_pitch_m},
              {"p_BTilt", ToJson(layout.p_BTilt)}, {"carry_height_m", layout.carry_height_m}};
}

void ReadLayout(const JsonView& view, CellLayout& layout) {
  if (const auto X_BS = view.Optional("X_BS")) layout.X_BS = TransformOfColumns(*X_BS);
  layout.X_FK = TransformOfColumns(view.Field("X_FK"));
  layout.X_FE = TransformOfColumns(view.Field("X_FE"));
  layout.X_FS = TransformOfColumns(view.Field("X_FS"));
  layout.X_BT = TransformOfColumns(view.Field("X_BT"));
  layout.tray_size_m = view.Field("tray_size_m").AsNumber();
  layout.tray_zone_m = view.Field("tray_zone_m").AsNumber();
  layout.slot_pitch_m = view.Field("slot_pitch_m").AsNumber();
  layout.p_BTilt = view.Field("p_BTilt").AsVector3();
  layout.carry_height_m = view.Field("carry_height_m").AsNumber();
}

Json FileJson(const ModelFile& file) {
  return Json{{"path", file.path}, {"text", file.text}, {"shipped", file.shipped}};
}

ModelFile FileFromJson(const JsonView& view) {
  return {view.Field("path").AsString(), view.Field("text").AsString(),
          view.Field("shipped").AsBool()};
}

Json ModelJson(const CellFiles& files) {
  return Json{{"cell", FileJson(files.cell)},
              {"arm", FileJson(files.arm)},
              {"gripper", FileJson(files.gripper)},
              {"wrist", FileJson(files.wrist)},
              {"scanner", FileJson(files.scanner)}};
}

/// Recordings of before 0.3 hold no model: there was one cell.
CellModel ModelFromJson(const std::optional<JsonView>& view) {
  if (!view) return LoadCellModel("leao2020");
  return ReadCellModel({FileFromJson(view->Field("cell")), FileFromJson(view->Field("arm")),
                        FileFromJson(view->Field("gripper")), FileFromJson(view->Field("wrist")),
                        FileFromJson(view->Field("scanner"))});
}

Json Parsed(const std::string& text, const std::string& source) {
  Json json = ParseJson(text, source);
  if (!json.is_object()) throw Error(ErrorKind::kBadData, source + ": no JSON object");
  return json;
}

}  // namespace

std::string HeaderToText(const CellRecordingHeader& header) {
  Json json;
  json["schema"] = kSchema;
  json["versions"] = header.versions;
  json["seed"] = header.seed;
  json["fingerprint"] = header.fingerprint;
  json["cell_model"] = ModelJson(header.model.files);
  json["layout"] = LayoutJson(header.model.layout);
  json["bin"] = Json{{"size_m", header.bin.size_m}, {"X_BN", PoseJson(header.bin.X_BN)}};
  json["part"] = PartToJson(header.part);
  if (!header.held.empty()) json["held"] = header.held;
  json["config_toml"] = header.config_toml;
  return json.dump();
}

CellRecordingHeader HeaderFromText(const std::string& text, const std::string& source) {
  const Json json = Parsed(text, source);
  const JsonView view(json, source);
  if (const JsonView schema = view.Field("schema"); schema.AsString() != kSchema) {
    schema.Fail("'" + schema.AsString() + "', this program reads '" + kSchema + "'");
  }
  CellRecordingHeader header;
  for (const auto& [name, version] : view.Field("versions").json().items()) {
    header.versions[name] = JsonView(version, source).AsString();
  }
  header.seed = view.Field("seed").AsInteger();
  header.fingerprint = view.Field("fingerprint").AsString();
  header.model = ModelFromJson(view.Optional("cell_model"));
  ReadLayout(view.Field("layout"), header.model.layout);
  const JsonView bin = view.Field("bin");
  const JsonView size = bin.Field("size_m");
  if (size.Size() != 3) size.Fail("three numbers are needed");
  for (std::size_t i = 0; i < 3; ++i) header.bin.size_m[i] = size.Item(i).AsNumber(0.01, 3.0);
  header.bin.X_BN = TransformOfColumns(bin.Field("X_BN"));
  header.part = PartFromJson(view.Field("part"));
  if (const auto held = view.Optional("held")) header.held = held->AsString();
  header.config_toml = view.Field("config_toml").AsString();
  return header;
}

std::string EndToText(const RecordingEnd& end) {
  return Json{{"reason", end.reason}, {"commands", end.commands}, {"reads", end.reads}}.dump();
}

RecordingEnd EndFromText(const std::string& text, const std::string& source) {
  const Json json = Parsed(text, source);
  const JsonView view(json, source);
  return {view.Field("reason").AsString(),
          static_cast<std::uint64_t>(view.Field("commands").AsInteger()),
          static_cast<std::uint64_t>(view.Field("reads").AsInteger())};
}

}  // namespace tubetwin
