#include "twin/render/stage.h"

#include <array>
#include <string_view>

#include "models/base/error.h"
#include "scenes/bin_body.h"
#include "scenes/engine/engine_error.h"
#include "scenes/tube_body.h"
#include "twin/render/cell_xml.h"
#include "twin/render/gl/scene_renderer.h"

namespace tubetwin {
namespace {

template <std::size_t N, class T, class U>
void Set(T (&to)[N], const std::array<U, N>& from) {
  for (std::size_t i = 0; i < N; ++i) to[i] = static_cast<T>(from[i]);
}

/// A distant light that shines along `dir`; its shadows are sharp around `centre`.
void AddLight(mjsBody& world, const Vector3& centre, const Vector3& dir, float diffuse,
              bool shadow) {
  mjsLight* light = mjs_addLight(&world, nullptr);
  light->type = mjLIGHT_DIRECTIONAL;
  light->castshadow = shadow;
  for (int k = 0; k < 3; ++k) {
    light->pos[k] = centre[k] - 2.0 * dir.normalized()[k];
    light->dir[k] = dir[k];
    light->ambient[k] = 0.0f;
    light->diffuse[k] = diffuse;
    light->specular[k] = shadow ? 0.25f : 0.05f;
  }
}

// What films show: from the bin's far wall to the tray, up to the arm's elbow.
const Vector3 kCellCentre_B(0.30, -0.30, 0.40);
constexpr double kCellReach_m = 1.8;

struct Paint {
  const char* name;  ///< The geom's, or with a star how it begins.
  std::array<float, 4> rgba;
};
constexpr std::array<float, 4> kPale = {0.80f, 0.81f, 0.83f, 1.0f};
constexpr std::array<float, 4> kBlue = {0.13f, 0.31f, 0.60f, 1.0f};
// Names that scenes share. A pale floor that tubes stand out from; an arm whose joints are told
// from its links. Later entries win.
constexpr Paint kPaints[] = {{"ground", {0.50f, 0.52f, 0.55f, 1.0f}},
                             {"plate", {0.38f, 0.40f, 0.43f, 1.0f}},
                             {"tray", {0.62f, 0.60f, 0.55f, 1.0f}},
                             {"bin_floor", {0.66f, 0.67f, 0.68f, 1.0f}},
                             {"bin_wall_*", {0.20f, 0.33f, 0.50f, 1.0f}},
                             {"bin_plinth", {0.30f, 0.32f, 0.35f, 1.0f}},
                             {"bin_mesh", {0.20f, 0.33f, 0.50f, 1.0f}},
                             {"arm_*", kPale},
                             {"arm_base", {0.25f, 0.26f, 0.28f, 1.0f}},
                             {"arm_upper arm", kBlue},
                             {"arm_forearm", kBlue},
                             {"arm_wrist", kBlue},
                             {"arm_force sensor", {0.55f, 0.56f, 0.58f, 1.0f}},
                             {"arm_scanner*", {0.12f, 0.12f, 0.13f, 1.0f}},
                             {"arm_gripper*", {0.22f, 0.23f, 0.25f, 1.0f}}};

bool Matches(const std::string& name, std::string_view pattern) {
  if (!pattern.ends_with('*')) return name == pattern;
  return name.starts_with(pattern.substr(0, pattern.size() - 1));
}

/// Paints what has a known name. Says whether any plane was there.
bool PaintGeoms(mjSpec& spec) {
  bool plane = false;
  for (mjsElement* element = mjs_firstElement(&spec, mjOBJ_GEOM); element != nullptr;
       element = mjs_nextElement(&spec, element)) {
    const std::string name = mjs_getString(mjs_getName(element));
    mjsGeom* geom = mjs_asGeom(element);
    plane = plane || geom->type == mjGEOM_PLANE;
    for (const Paint& paint : kPaints) {
      if (Matches(name, paint.name)) Set(geom->rgba, paint.rgba);
    }
  }
  return plane;
}

/// The hall's floor, just below the cell's plate: for the eye only.
void AddFloor(mjSpec& spec) {
  constexpr double kPlateThickness_m = 0.02;
  mjsGeom* floor = mjs_addGeom(mjs_findBody(&spec, "world"), nullptr);
  SetName(floor->element, "tubetwin_floor");
  floor->type = mjGEOM_PLANE;
  floor->pos[2] = -kPlateThickness_m - 0.001;
  floor->size[0] = floor->size[1] = 0.0;  // Endless.
  floor->size[2] = 1.0;
  floor->contype = floor->conaffinity = 0;
  Set(floor->rgba, std::array{0.56f, 0.58f, 0.60f, 1.0f});
}

/// Puts a mesh in the place of plain shapes. It has no part in anything but pictures.
void AddVisual(mjSpec& spec, const Recording::Visual& visual, int number,
               const std::string& source) {
  mjsBody* body = mjs_findBody(&spec, visual.body.c_str());
  if (body == nullptr) {
    throw Error(ErrorKind::kBadData,
                source + ": a visual belongs to body '" + visual.body + "', which the cell lacks");
  }
  std::vector<mjsElement*> replaced;
  for (mjsElement* geom = mjs_firstChild(body, mjOBJ_GEOM, 0); geom != nullptr;
       geom = mjs_nextChild(body, geom, 0)) {
    const std::string name = mjs_getString(mjs_getName(geom));
    for (const std::string& start : visual.replaces) {
      if (!name.starts_with(start)) continue;
      replaced.push_back(geom);
      break;
    }
  }
  for (mjsElement* geom : replaced) mjs_delete(&spec, geom);
  std::vector<float> vertices;
  std::vector<int> faces;
  for (const Vector3& v : visual.mesh.vertices) {
    for (int k = 0; k < 3; ++k) vertices.push_back(static_cast<float>(v[k]));
  }
  for (const auto& face : visual.mesh.faces) faces.insert(faces.end(), face.begin(), face.end());
  const std::string name =
      visual.body == "world" ? "bin_mesh" : "arm_mesh_" + std::to_string(number);
  mjsMesh* mesh = mjs_addMesh(&spec, nullptr);
  SetName(mesh->element, name);
  mesh->inertia = mjMESH_INERTIA_SHELL;  // Whatever the user's mesh encloses.
  mjs_setFloat(mesh->uservert, vertices.data(), static_cast<int>(vertices.size()));
  mjs_setInt(mesh->userface, faces.data(), static_cast<int>(faces.size()));
  mjsGeom* geom = mjs_addGeom(body, nullptr);
  SetName(geom->element, name);
  geom->type = mjGEOM_MESH;
  SetString(geom->meshname, name);
  geom->contype = geom->conaffinity = 0;
  geom->mass = 0.0;
}

}  // namespace

std::array<double, 3> PileColour(int tube) {
  // Ten colours that stay apart on a grey floor.
  static constexpr std::array<double, 3> kColours[] = {
      {0.90, 0.35, 0.22}, {0.20, 0.55, 0.80}, {0.95, 0.75, 0.20}, {0.30, 0.65, 0.40},
      {0.62, 0.40, 0.70}, {0.92, 0.92, 0.90}, {0.95, 0.55, 0.65}, {0.35, 0.75, 0.75},
      {0.55, 0.40, 0.28}, {0.28, 0.30, 0.38}};
  return kColours[static_cast<std::size_t>(tube) % std::size(kColours)];
}

void DressStage(mjSpec& spec, const Vector3& centre_B, double reach_m, StageQuality quality) {
  mjsBody* world = mjs_findBody(&spec, "world");
  while (mjsElement* light = mjs_firstElement(&spec, mjOBJ_LIGHT)) mjs_delete(&spec, light);
  AddLight(*world, centre_B, {-0.40, 0.50, -1.0}, 0.58f, true);
  AddLight(*world, centre_B, {-0.9, 0.3, -0.25}, 0.20f, false);
  AddLight(*world, centre_B, {0.7, 0.6, -0.5}, 0.16f, false);
  if (!PaintGeoms(spec)) AddFloor(spec);

  mjVisual& visual = spec.visual;
  visual.global.offwidth = kPictureWidth;
  visual.global.offheight = kPictureHeight;
  visual.global.fovy = static_cast<float>(kFieldOfView_deg);
  visual.global.orthographic = 0;
  const bool still = quality == StageQuality::kStill;
  visual.quality.shadowsize = still ? 4096 : 1536;
  visual.quality.offsamples = still ? 4 : 0;
  visual.quality.numslices = still ? 28 : 14;
  visual.quality.numstacks = still ? 16 : 6;
  visual.quality.numquads = 1;
  Set(visual.headlight.ambient, std::array{0.32, 0.32, 0.34});
  Set(visual.headlight.diffuse, std::array{0.16, 0.16, 0.16});
  Set(visual.headlight.specular, std::array{0.05, 0.05, 0.05});
  visual.headlight.active = 1;
  // Clip planes and shadow box are multiples of the extent: one metre, whatever the scene.
  spec.stat.extent = 1.0;
  for (int k = 0; k < 3; ++k) spec.stat.center[k] = centre_B[k];
  visual.map.znear = 0.05f;
  visual.map.zfar = 60.0f;
  visual.map.shadowclip = static_cast<float>(reach_m);
}

MjModel CompileStage(const Recording& recording, const std::string& source, StageQuality quality) {
  const MjSpec spec = ParseCellXml(recording.cell_xml, source);
  int number = 0;
  for (const Recording::Visual& visual : recording.visuals) {
    AddVisual(*spec, visual, number++, source);
  }
  DressStage(*spec, kCellCentre_B, kCellReach_m, quality);
  try {
    return Compile(*spec, source);
  } catch (const Error& problem) {
    throw Error(ErrorKind::kBadData, problem.what());
  }
}

MjModel CompileStage(const Pile& pile, const std::vector<std::array<double, 3>>& colours) {
  TT_CHECK(colours.size() == pile.tubes.size());
  const MjSpec spec = MakeSpec();
  BinBodyOptions bin;
  bin.X_WN = pile.bin.X_BN;
  AddBin(*spec, pile.bin, bin);
  // A table under the bin, level with it whatever the bin's tilt.
  AddGround(*spec, pile.bin.X_BN * Translation(0, 0, -Bin::kWallThickness_m), bin);
  TubeBodyOptions tube_options =
      MakeTubeBodyOptions(pile.part, NominalPhysics(pile.part), pile.bin.X_BN, 0);
  for (std::size_t i = 0; i < pile.tubes.size(); ++i) {
    tube_options.colour_rgb = colours[i];
    TubeBody(*spec, "tube_" + std::to_string(pile.tubes[i].id), pile.tubes[i], tube_options);
  }
  const Vector3 centre_B = pile.bin.X_BN * Vector3(0, 0, 0.5 * pile.bin.wall_m());
  DressStage(*spec, centre_B, 0.5 * Vector3(pile.bin.size_m.data()).norm() + 0.4,
             StageQuality::kStill);
  return Compile(*spec, "picture of a pile");
}

}  // namespace tubetwin
