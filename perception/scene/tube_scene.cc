#include "perception/scene/tube_scene.h"

#include <algorithm>
#include <set>

#include "models/base/error.h"
#include "models/base/json.h"
#include "models/base/json_text.h"
#include "models/base/text.h"

namespace tubetwin {

const char* ToString(TubeClass c) {
  switch (c) {
    case TubeClass::kFree:
      return "free";
    case TubeClass::kWeak:
      return "weak";
    case TubeClass::kStrong:
      return "strong";
  }
  TT_CHECK(!"a class outside the enumeration");
  return "";
}

const char* ToString(BinContent content) {
  switch (content) {
    case BinContent::kEmpty:
      return "empty";
    case BinContent::kNotEmpty:
      return "not_empty";
    case BinContent::kUnseen:
      return "unseen";
  }
  TT_CHECK(!"a content outside the enumeration");
  return "";
}

namespace {

// What a tubes.json may hold; of a pile's tubes the same is asked.
constexpr double kFarthest_m = 3.0;  // From the bin's floor centre, any coordinate.
constexpr double kClosestNodes_m = 1e-6, kLongest_m = 10.0;
constexpr double kThinnest_m = 0.001, kThickest_m = 0.1;
constexpr std::size_t kMaxTubes = 200, kMaxNodes = 2000, kMaxCrossings = 20000;
constexpr std::size_t kMaxPoints = 1000000, kMaxFloorCells = 2000;

BinContent ContentFromJson(const JsonView& view) {
  const std::string text = view.AsString();
  for (const BinContent c : {BinContent::kEmpty, BinContent::kNotEmpty, BinContent::kUnseen}) {
    if (text == ToString(c)) return c;
  }
  view.Fail("is '" + text + "', allowed are empty, not_empty, unseen");
}

/// Rows of characters, '#' unseen and '.' seen: small, and a person can look at it.
Json FloorToJson(const UnseenFloor& floor) {
  Json rows = Json::array();
  for (int j = 0; j < floor.rows; ++j) {
    std::string row;
    for (int i = 0; i < floor.columns; ++i) {
      row += floor.unseen[static_cast<std::size_t>(j) * floor.columns + i] != 0 ? '#' : '.';
    }
    rows.push_back(row);
  }
  return Json{{"first_corner_m",
               {-0.5 * floor.columns * floor.cell_x_m, -0.5 * floor.rows * floor.cell_y_m}},
              {"cell_m", {floor.cell_x_m, floor.cell_y_m}},
              {"rows", rows}};
}

/// A list of at most `most`: whatever comes after it takes time for each.
void RequireAtMost(const JsonView& list, std::size_t most) {
  if (list.Size() <= most) return;
  list.Fail("has " + std::to_string(list.Size()) + " entries, allowed are up to " +
            std::to_string(most));
}

UnseenFloor FloorFromJson(const JsonView& view) {
  UnseenFloor floor;
  const std::vector<double> cell_m = view.Field("cell_m").AsNumbers();
  if (cell_m.size() != 2) view.Field("cell_m").Fail("two numbers are needed");
  floor.cell_x_m = view.Field("cell_m").Item(0).AsNumber(0.0, kFarthest_m);
  floor.cell_y_m = view.Field("cell_m").Item(1).AsNumber(0.0, kFarthest_m);
  const JsonView rows = view.Field("rows");
  RequireAtMost(rows, kMaxFloorCells);
  floor.rows = static_cast<int>(rows.Size());
  for (std::size_t j = 0; j < rows.Size(); ++j) {
    const std::string row = rows.Item(j).AsString();
    if (row.size() > kMaxFloorCells) rows.Item(j).Fail("is longer than 2000 characters");
    if (j == 0) floor.columns = static_cast<int>(row.size());
    if (static_cast<int>(row.size()) != floor.columns ||
        row.find_first_not_of("#.") != std::string::npos) {
      rows.Item(j).Fail("rows of equally many '#' and '.' are needed");
    }
    for (const char c : row) floor.unseen.push_back(c == '#' ? 1 : 0);
  }
  return floor;
}

TubeClass ClassFromJson(const JsonView& view) {
  const std::string text = view.AsString();
  for (const TubeClass c : {TubeClass::kFree, TubeClass::kWeak, TubeClass::kStrong}) {
    if (text == ToString(c)) return c;
  }
  view.Fail("is '" + text + "', allowed are free, weak, strong");
}

std::vector<int> IdsFromJson(const JsonView& view) {
  std::vector<int> out;
  for (std::size_t i = 0; i < view.Size(); ++i) out.push_back(CountFromJson(view.Item(i)));
  return out;
}

std::vector<Vector3> PointsFromJson(const JsonView& view, std::size_t most) {
  RequireAtMost(view, most);
  std::vector<Vector3> points = view.AsPolyline();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      view.Item(i).Item(k).AsNumber(-kFarthest_m, kFarthest_m);
    }
  }
  return points;
}

Polyline CenterlineFromJson(const JsonView& view) {
  Polyline line = PointsFromJson(view, kMaxNodes);
  if (line.size() < 2) view.Fail("two points are needed");
  for (std::size_t i = 1; i < line.size(); ++i) {
    // Also of points that lie together, which have no direction.
    if ((line[i] - line[i - 1]).norm() >= kClosestNodes_m) continue;
    view.Item(i).Fail("is " + Number((line[i] - line[i - 1]).norm()) +
                      " m from the point before, allowed are " + Number(kClosestNodes_m) +
                      " m and more");
  }
  if (const double length_m = Length(line); length_m > kLongest_m) {
    view.Fail("is " + Number(length_m) + " m long, allowed are up to " + Number(kLongest_m) + " m");
  }
  return line;
}

Json TubeToJson(const PerceivedTube& tube) {
  Json json;
  json["id"] = tube.id;
  json["centerline_m"] = ToJson(tube.centerline_N);
  json["radius_m"] = tube.radius_m;
  json["length_m"] = tube.length_m;
  json["visible_fraction"] = tube.visible_fraction;
  json["confidence"] = tube.confidence;
  json["class"] = ToString(tube.tube_class);
  if (tube.class_paper) json["class_paper"] = ToString(*tube.class_paper);
  json["over"] = tube.over;
  json["under"] = tube.under;
  json["hooked"] = tube.hooked;
  Json visible = Json::array();
  for (const char v : tube.node_visible) visible.push_back(v != 0 ? 1 : 0);
  json["node_visible"] = visible;
  return json;
}

PerceivedTube TubeFromJson(const JsonView& view) {
  PerceivedTube tube;
  tube.id = CountFromJson(view.Field("id"));
  tube.centerline_N = CenterlineFromJson(view.Field("centerline_m"));
  tube.radius_m = view.Field("radius_m").AsNumber(kThinnest_m, kThickest_m);
  tube.length_m = view.Field("length_m").AsNumber(kClosestNodes_m, kLongest_m);
  tube.visible_fraction = view.Field("visible_fraction").AsNumber(0.0, 1.0);
  tube.confidence = view.Field("confidence").AsNumber(0.0, 1.0);
  tube.tube_class = ClassFromJson(view.Field("class"));
  if (const auto paper = view.Optional("class_paper")) tube.class_paper = ClassFromJson(*paper);
  tube.over = IdsFromJson(view.Field("over"));
  tube.under = IdsFromJson(view.Field("under"));
  if (const auto hooked = view.Optional("hooked")) tube.hooked = IdsFromJson(*hooked);
  tube.node_visible.assign(tube.centerline_N.size(), 1);
  if (const auto visible = view.Optional("node_visible")) {
    if (visible->Size() != tube.centerline_N.size()) {
      visible->Fail("as many values as centerline_m has points are needed");
    }
    for (std::size_t i = 0; i < visible->Size(); ++i) {
      tube.node_visible[i] = visible->Item(i).AsNumber(0, 1) > 0 ? 1 : 0;
    }
  }
  return tube;
}

Json CrossingToJson(const Crossing& crossing) {
  return Json{{"over", crossing.over},
              {"under", crossing.under},
              {"at_over_m", crossing.at_over_m},
              {"at_under_m", crossing.at_under_m},
              {"gap_m", crossing.gap_m},
              {"confidence", crossing.confidence},
              {"under_from_m", crossing.under_from_m},
              {"under_to_m", crossing.under_to_m},
              {"visible", crossing.visible}};
}

Crossing CrossingFromJson(const JsonView& view) {
  Crossing crossing;
  const auto along = [](const JsonView& field) { return field.AsNumber(-kLongest_m, kLongest_m); };
  crossing.over = CountFromJson(view.Field("over"));
  crossing.under = CountFromJson(view.Field("under"));
  crossing.at_over_m = along(view.Field("at_over_m"));
  crossing.at_under_m = along(view.Field("at_under_m"));
  crossing.gap_m = along(view.Field("gap_m"));
  crossing.confidence = view.Field("confidence").AsNumber(0.0, 1.0);
  crossing.under_from_m = crossing.under_to_m = crossing.at_under_m;
  if (const auto from = view.Optional("under_from_m")) crossing.under_from_m = along(*from);
  if (const auto to = view.Optional("under_to_m")) crossing.under_to_m = along(*to);
  if (const auto visible = view.Optional("visible")) crossing.visible = visible->AsBool();
  return crossing;
}

void CheckIds(const TubeScene& scene, const JsonView& document) {
  std::set<int> ids;
  const JsonView tubes = document.Field("tubes");
  for (std::size_t i = 0; i < scene.tubes.size(); ++i) {
    if (!ids.insert(scene.tubes[i].id).second) {
      tubes.Item(i).Field("id").Fail("is " + std::to_string(scene.tubes[i].id) +
                                     ", which another tube has already");
    }
  }
  const JsonView crossings = document.Field("crossings");
  for (std::size_t i = 0; i < scene.crossings.size(); ++i) {
    for (const char* field : {"over", "under"}) {
      const JsonView view = crossings.Item(i).Field(field);
      if (!ids.contains(static_cast<int>(view.AsInteger())))
        view.Fail("names no tube of this file");
    }
  }
}

}  // namespace

Json ToJson(const TubeScene& scene) {
  Json json;
  json["schema"] = "tubetwin/tubes/1";
  json["frame"] = "bin";
  json["tubes"] = Json::array();
  for (const PerceivedTube& tube : scene.tubes) json["tubes"].push_back(TubeToJson(tube));
  json["crossings"] = Json::array();
  for (const Crossing& c : scene.crossings) json["crossings"].push_back(CrossingToJson(c));
  json["bin_content"] = ToString(scene.bin_content);
  json["bin_content_reason"] = scene.bin_content_reason;
  json["unseen_m3"] = scene.unseen_m3;
  json["unseen_floor_m2"] = scene.unseen_floor_m2;
  json["radius_estimate_m"] =
      scene.radius_estimate_m ? Json(*scene.radius_estimate_m) : Json(nullptr);
  json["warnings"] = scene.warnings;
  json["unseen_floor"] = FloorToJson(scene.unseen_floor);
  json["unexplained_points"] = scene.unexplained_N.size();
  json["unexplained_m"] = ToJson(scene.unexplained_N);
  const TubeScene::Timing& t = scene.timing_ms;
  json["timing_ms"] =
      Json{{"load", t.load}, {"filter", t.filter},       {"segment", t.segment}, {"fit", t.fit},
           {"join", t.join}, {"crossings", t.crossings}, {"total", t.total}};
  json["threads"] = scene.threads;
  return json;
}

TubeScene TubeSceneFromJson(const JsonView& document) {
  RequireSchema(document, "tubes");
  const std::string frame = document.Field("frame").AsString();
  if (frame != "bin") document.Field("frame").Fail("is '" + frame + "', 'bin' is needed");
  TubeScene scene;
  const JsonView tubes = document.Field("tubes");
  RequireAtMost(tubes, kMaxTubes);
  for (std::size_t i = 0; i < tubes.Size(); ++i) scene.tubes.push_back(TubeFromJson(tubes.Item(i)));
  const JsonView crossings = document.Field("crossings");
  RequireAtMost(crossings, kMaxCrossings);
  for (std::size_t i = 0; i < crossings.Size(); ++i) {
    scene.crossings.push_back(CrossingFromJson(crossings.Item(i)));
  }
  CheckIds(scene, document);
  scene.unseen_m3 = document.Field("unseen_m3").AsNumber(0.0, 1e6);
  if (const auto floor = document.Optional("unseen_floor_m2")) {
    scene.unseen_floor_m2 = floor->AsNumber(0.0, 1e6);
  }
  if (const auto radius = document.Optional("radius_estimate_m")) {
    scene.radius_estimate_m = radius->AsNumber(0.0, 1.0);
  }
  if (const auto warnings = document.Optional("warnings")) {
    for (std::size_t i = 0; i < warnings->Size(); ++i) {
      scene.warnings.push_back(warnings->Item(i).AsString());
    }
  }
  if (const auto floor = document.Optional("unseen_floor")) {
    scene.unseen_floor = FloorFromJson(*floor);
  }
  document.Field("unexplained_points").AsNumber(0, 2e9);
  if (const auto points = document.Optional("unexplained_m")) {
    scene.unexplained_N = PointsFromJson(*points, kMaxPoints);
  }
  scene.bin_content = scene.tubes.empty() ? BinContent::kUnseen : BinContent::kNotEmpty;
  if (const auto content = document.Optional("bin_content")) {
    scene.bin_content = ContentFromJson(*content);
    scene.bin_content_reason = document.Field("bin_content_reason").AsString();
  }
  const JsonView timing = document.Field("timing_ms");
  TubeScene::Timing& t = scene.timing_ms;
  t.load = timing.Field("load").AsNumber();
  t.filter = timing.Field("filter").AsNumber();
  t.segment = timing.Field("segment").AsNumber();
  t.fit = timing.Field("fit").AsNumber();
  t.join = timing.Field("join").AsNumber();
  t.crossings = timing.Field("crossings").AsNumber();
  t.total = timing.Field("total").AsNumber();
  scene.threads = static_cast<int>(document.Field("threads").AsNumber(1, 4096));
  return scene;
}

}  // namespace tubetwin
