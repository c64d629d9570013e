#include "twin/render/stage.h"

#include <array>

#include "hw_bridge/base/error.h"
#include "scenes/bin_body.h"
#include "scenes/engine/engine_error.h"
#include "scenes/tube_body.h"
#include "twin/render/gl/scene_renderer.h"

namespace tubetwin {
namespace {

template <std::size_t N, class T, class U>
void Set(T (&to)[N], const std::array<U, N>& from) {
  for (std::size_t i = 0; i < N; ++i) to[i] = static_cast<T>(from[i]);
}

void AddLight(mjsBody& world, const Vector3& pos, const Vector3& dir, float diffuse, bool shadow) {
  mjsLight* light = mjs_addLight(&world, nullptr);
  light->type = mjLIGHT_DIRECTIONAL;
  light->castshadow = shadow;
  for (int k = 0; k < 3; ++k) {
    light->pos[k] = pos[k];
    light->dir[k] = dir[k];
    light->ambient[k] = 0.0f;
    light->diffuse[k] = diffuse;
    light->specular[k] = shadow ? 0.25f : 0.05f;
  }
}

/// Colours of things that every scene names the same way: a pale floor that tubes stand out from.
void PaintBin(mjSpec& spec) {
  for (mjsElement* element = mjs_firstElement(&spec, mjOBJ_GEOM); element != nullptr;
       element = mjs_nextElement(&spec, element)) {
    const std::string name = mjs_getString(mjs_getName(element));
    mjsGeom* geom = mjs_asGeom(element);
    if (name == "bin_floor") Set(geom->rgba, std::array{0.70f, 0.71f, 0.72f, 1.0f});
    if (name.starts_with("bin_wall_")) Set(geom->rgba, std::array{0.20f, 0.33f, 0.50f, 1.0f});
    if (name == "ground") Set(geom->rgba, std::array{0.50f, 0.52f, 0.55f, 1.0f});
  }
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

void DressStage(mjSpec& spec) {
  mjsBody* world = mjs_findBody(&spec, "world");
  while (mjsElement* light = mjs_firstElement(&spec, mjOBJ_LIGHT)) mjs_delete(&spec, light);
  AddLight(*world, {1.6, -1.2, 3.0}, {-0.45, 0.35, -1.0}, 0.62f, true);
  AddLight(*world, {-1.0, -2.0, 2.0}, {0.6, 0.8, -0.6}, 0.22f, false);

  PaintBin(spec);
  mjsTexture* sky = mjs_addTexture(&spec, nullptr);
  SetName(sky->element, "tubetwin_sky");
  sky->type = mjTEXTURE_SKYBOX;
  sky->builtin = mjBUILTIN_GRADIENT;
  Set(sky->rgb1, std::array{0.86, 0.90, 0.94});
  Set(sky->rgb2, std::array{0.42, 0.50, 0.60});
  sky->width = 256;
  sky->height = 1536;

  mjVisual& visual = spec.visual;
  visual.global.offwidth = kPictureWidth;
  visual.global.offheight = kPictureHeight;
  visual.global.fovy = static_cast<float>(kFieldOfView_deg);
  visual.global.orthographic = 0;
  visual.quality.shadowsize = 2048;
  visual.quality.offsamples = 4;
  visual.quality.numslices = 20;
  visual.quality.numstacks = 10;
  visual.quality.numquads = 1;
  Set(visual.headlight.ambient, std::array{0.32, 0.32, 0.34});
  Set(visual.headlight.diffuse, std::array{0.16, 0.16, 0.16});
  Set(visual.headlight.specular, std::array{0.05, 0.05, 0.05});
  visual.headlight.active = 1;
  // Clip planes and shadow box are multiples of the extent: one metre, whatever the scene.
  spec.stat.extent = 1.0;
  Set(spec.stat.center, std::array{0.35, -0.25, 0.2});
  visual.map.znear = 0.05f;
  visual.map.zfar = 30.0f;
  visual.map.shadowclip = 1.6f;
}

MjModel CompileStage(const std::string& cell_xml, const std::string& source) {
  InitEngine();
  char error[512] = "";
  mjSpec* parsed = nullptr;
  GuardEngine([&] { parsed = mj_parseXMLString(cell_xml.c_str(), nullptr, error, sizeof error); });
  const MjSpec spec(parsed);
  if (spec == nullptr) {
    throw Error(ErrorKind::kBadData, source + ": the cell's XML does not parse: " + error);
  }
  DressStage(*spec);
  try {
    return Compile(*spec, source);
  } catch (const Error& problem) {
    throw Error(ErrorKind::kBadData, problem.what());
  }
}

MjModel CompileStage(const Pile& pile) {
  const MjSpec spec = MakeSpec();
  BinBodyOptions bin;
  bin.X_WN = pile.bin.X_BN;
  AddBin(*spec, pile.bin, bin);
  // A table under the bin, level with it whatever the bin's tilt.
  AddGround(*spec, pile.bin.X_BN * Translation(0, 0, -Bin::kWallThickness_m), bin);
  TubeBodyOptions tube_options =
      MakeTubeBodyOptions(pile.part, NominalPhysics(pile.part), pile.bin.X_BN);
  for (std::size_t i = 0; i < pile.tubes.size(); ++i) {
    tube_options.colour_rgb = PileColour(static_cast<int>(i));
    TubeBody(*spec, "tube_" + std::to_string(pile.tubes[i].id), pile.tubes[i], tube_options);
  }
  DressStage(*spec);
  return Compile(*spec, "picture of a pile");
}

}  // namespace tubetwin
