// tube_model SCENE.json > MODEL.xml: one tube as every scene of the program has it, alone in a
// world without ground, for tests/validation, which steps it with the stock engine.
//
// SCENE.json: part (name or part file), centerline ([[x, y, z], ...], metres, one node per link end
// for hoses), optional rest_centerline, optional timestep_s and impratio.

#include <array>
#include <cstdio>
#include <string>

#include <mujoco/mujoco.h>

#include "models/base/error.h"
#include "models/base/json.h"
#include "models/part.h"
#include "models/physics.h"
#include "scenes/engine/mj_handles.h"
#include "scenes/tube_body.h"

namespace tubetwin {
namespace {

std::string Xml(const mjSpec& spec) {
  std::string xml(1 << 20, '\0');
  std::array<char, 1000> error{};
  if (mj_saveXMLString(&spec, xml.data(), static_cast<int>(xml.size()), error.data(),
                       static_cast<int>(error.size())) != 0) {
    throw Error(ErrorKind::kInternal, "the tube cannot be written: " + std::string(error.data()));
  }
  xml.resize(xml.find('\0'));
  return xml;
}

std::string TubeModel(const std::string& path) {
  const Json read = ReadJsonFile(path);
  const JsonView scene(read, path);
  const Part part = LoadPart(scene.Field("part").AsString());
  PileTube tube;
  tube.centerline_N = scene.Field("centerline").AsPolyline();
  tube.radius_m = part.radius_m;
  tube.mass_kg = part.mass_kg;
  if (const auto rest = scene.Optional("rest_centerline")) {
    tube.rest_centerline_N = rest->AsPolyline();
  }
  EngineOptions engine;
  if (const auto step = scene.Optional("timestep_s")) engine.timestep_s = step->AsNumber(1e-6, 0.1);
  if (const auto ratio = scene.Optional("impratio")) engine.impratio = ratio->AsNumber(0.1, 1e4);
  MjSpec spec = MakeSpec(engine);
  const TubeBodyOptions options =
      MakeTubeBodyOptions(part, NominalPhysics(part), RigidTransform::Identity(), 0);
  const TubeBody body(*spec, "tube0", tube, options);
  Compile(*spec, "the tube");
  return Xml(*spec);
}

}  // namespace
}  // namespace tubetwin

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: tube_model SCENE.json > MODEL.xml\n");
    return 64;
  }
  try {
    std::puts(tubetwin::TubeModel(arguments[1]).c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tube_model: %s\n", error.what());
    return 1;
  }
  return 0;
}
