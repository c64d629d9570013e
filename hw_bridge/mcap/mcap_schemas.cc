#include "hw_bridge/mcap/mcap_schemas.h"

#include <initializer_list>
#include <utility>

#include "models/base/json.h"

namespace tubetwin {
namespace {

using Fields = std::initializer_list<std::pair<const char*, Json>>;

Json Type(const char* type) { return Json{{"type", type}}; }
Json Number() { return Type("number"); }
Json Integer() { return Type("integer"); }
Json Text() { return Type("string"); }
Json Flag() { return Type("boolean"); }

/// An object whose fields are all there.
Json Object(const Fields& fields) {
  Json json = Type("object");
  json["properties"] = Json::object();
  json["required"] = Json::array();
  for (const auto& [name, schema] : fields) {
    json["properties"][name] = schema;
    json["required"].push_back(name);
  }
  return json;
}

Json Array(Json items) {
  Json json = Type("array");
  json["items"] = std::move(items);
  return json;
}

Json Time() { return Object({{"sec", Integer()}, {"nsec", Integer()}}); }
Json Vector() { return Object({{"x", Number()}, {"y", Number()}, {"z", Number()}}); }
Json Quaternion() {
  return Object({{"x", Number()}, {"y", Number()}, {"z", Number()}, {"w", Number()}});
}

McapSchema Schema(const std::string& name, Json json) {
  Json titled = {{"title", name}};
  titled.update(json);
  return {name, titled.dump()};
}

}  // namespace

McapSchema JointStatesSchema() {
  const Json joint = Object({{"name", Text()}, {"position", Number()}, {"velocity", Number()}});
  return Schema("foxglove.JointStates", Object({{"timestamp", Time()}, {"joints", Array(joint)}}));
}

McapSchema FrameTransformsSchema() {
  const Json transform = Object({{"timestamp", Time()},
                                 {"parent_frame_id", Text()},
                                 {"child_frame_id", Text()},
                                 {"translation", Vector()},
                                 {"rotation", Quaternion()}});
  return Schema("foxglove.FrameTransforms", Object({{"transforms", Array(transform)}}));
}

McapSchema PointCloudSchema() {
  const Json pose = Object({{"position", Vector()}, {"orientation", Quaternion()}});
  const Json field = Object({{"name", Text()}, {"offset", Integer()}, {"type", Integer()}});
  Json data = Text();
  data["contentEncoding"] = "base64";
  return Schema("foxglove.PointCloud", Object({{"timestamp", Time()},
                                               {"frame_id", Text()},
                                               {"pose", pose},
                                               {"point_stride", Integer()},
                                               {"fields", Array(field)},
                                               {"data", data}}));
}

McapSchema LogSchema() {
  return Schema("foxglove.Log", Object({{"timestamp", Time()},
                                        {"level", Integer()},
                                        {"message", Text()},
                                        {"name", Text()},
                                        {"file", Text()},
                                        {"line", Integer()}}));
}

McapSchema WrenchSchema() {
  return Schema("tubetwin.Wrench", Object({{"timestamp", Time()},
                                           {"frame_id", Text()},
                                           {"force", Vector()},
                                           {"torque", Vector()},
                                           {"saturated", Flag()}}));
}

McapSchema ArmSchema() {
  return Schema("tubetwin.ArmState", Object({{"timestamp", Time()},
                                             {"mode", Text()},
                                             {"progress_s", Number()},
                                             {"planned_s", Number()},
                                             {"done", Flag()},
                                             {"fault", Text()}}));
}

McapSchema GripperSchema() {
  return Schema("tubetwin.GripperState", Object({{"timestamp", Time()},
                                                 {"opening_m", Number()},
                                                 {"requested_m", Number()},
                                                 {"object", Text()},
                                                 {"activated", Flag()},
                                                 {"fault", Integer()}}));
}

}  // namespace tubetwin
