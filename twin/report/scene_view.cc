#include "twin/report/scene_view.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "models/base/json.h"
#include "twin/report/text.h"

namespace tubetwin {
namespace {

constexpr double kStep_m = 1e-4, kStep_N = 0.01, kUnit = 32767.0;

/// 16-bit little-endian integers, clamped.
class Shorts {
 public:
  void Add(double value) {
    const auto number = static_cast<std::int16_t>(std::lround(std::clamp(value, -kUnit, kUnit)));
    const auto bits = static_cast<std::uint16_t>(number);
    bytes_ += static_cast<char>(bits & 0xFF);
    bytes_ += static_cast<char>(bits >> 8);
  }
  void AddPoint(const Vector3& p_m) {
    for (int k = 0; k < 3; ++k) Add(p_m[k] / kStep_m);
  }
  std::string Text() const { return Base64(bytes_); }

 private:
  std::string bytes_;
};

double Rounded(double value) { return std::round(1e4 * value) / 1e4; }

Json PoseJson(const RigidTransform& X) {
  const Eigen::Quaterniond q(X.linear());
  Json out = Json::array();
  for (int k = 0; k < 3; ++k) out.push_back(Rounded(X.translation()[k]));
  for (const double part : {q.w(), q.x(), q.y(), q.z()}) out.push_back(Rounded(part));
  return out;
}

Json GeomsJson(const CellTrack& track) {
  Json geoms = Json::array();
  for (const CellTrack::Geom& geom : track.geoms) {
    const bool is_tube = geom.name.rfind("tube", 0) == 0;
    Json out;
    out["body"] = geom.body;
    out["shape"] = static_cast<int>(geom.shape);
    out["size"] = Json::array();
    for (const double size : geom.size_m) out["size"].push_back(Rounded(size));
    out["pose"] = PoseJson(geom.X_bodyGeom);
    out["tube"] = is_tube ? std::atoi(geom.name.c_str() + 4) : 0;
    out["rgb"] = Json::array();
    for (int k = 0; k < 3; ++k) out["rgb"].push_back(std::lround(255.0 * geom.rgba[k]));
    geoms.push_back(std::move(out));
  }
  return geoms;
}

Json BodiesJson(const CellTrack& track) {
  Json bodies = Json::array();
  for (const CellTrack::Body& body : track.bodies) {
    Shorts keys;
    for (const CellTrack::Key& key : body.keys) {
      const Eigen::Quaterniond q(key.X_BBody.linear());
      keys.Add(key.sample);
      keys.AddPoint(key.X_BBody.translation());
      for (const double part : {q.w(), q.x(), q.y(), q.z()}) keys.Add(kUnit * part);
    }
    bodies.push_back(keys.Text());
  }
  return bodies;
}

Json LookJson(const Recording& recording, const Recording::Overlay& overlay, int sample) {
  Json look;
  look["sample"] = sample;
  look["tubes"] = Json::array();
  for (std::size_t i = 0; i < overlay.lines_N.size(); ++i) {
    Shorts line;
    for (const Vector3& p_NP : Simplified(overlay.lines_N[i], 5e-4)) {
      line.AddPoint(recording.bin.X_BN * p_NP);
    }
    look["tubes"].push_back(Json{{"line", line.Text()},
                                 {"class", overlay.classes[i]},
                                 {"target", static_cast<int>(i) == overlay.target}});
  }
  Shorts cloud;
  for (const Vector3& p_NP : overlay.cloud_N) cloud.AddPoint(recording.bin.X_BN * p_NP);
  look["cloud"] = cloud.Text();
  return look;
}

bool IsLook(const Recording& recording, int overlay) {
  return overlay >= 0 && !(recording.overlays[overlay].lines_N.empty() &&
                           recording.overlays[overlay].cloud_N.empty());
}

}  // namespace

const Recording::Overlay* LookDuring(const Recording& recording, int from, int to) {
  for (int i = to - 1; i >= from; --i) {
    const int overlay = recording.frames[i].overlay;
    if (IsLook(recording, overlay)) return &recording.overlays[overlay];
  }
  return nullptr;
}

Json AttemptScene(const Recording& recording, const CellTrack& track, int from, int stride) {
  Json out;
  out["sample_s"] = track.sample_s;
  out["samples"] = track.samples;
  out["cell"] = GeomsJson(track);
  out["bodies"] = BodiesJson(track);
  Shorts path, force;
  for (const Vector3& p_BP : track.p_BPs) path.AddPoint(p_BP);
  out["path"] = path.Text();
  out["captions"] = Json::array();
  out["looks"] = Json::array();
  int caption = -1, overlay = -1;
  for (int sample = 0; sample < track.samples; ++sample) {
    const Recording::Frame& frame = recording.frames[from + sample * stride];
    force.Add(frame.force_N / kStep_N);
    if (frame.caption != caption && frame.caption >= 0) {
      out["captions"].push_back(Json::array({sample, recording.captions[frame.caption]}));
    }
    if (frame.overlay != overlay && IsLook(recording, frame.overlay)) {
      out["looks"].push_back(LookJson(recording, recording.overlays[frame.overlay], sample));
    }
    caption = frame.caption;
    overlay = frame.overlay;
  }
  out["force"] = force.Text();
  const Bin& bin = recording.bin;
  out["bin"] = Json{{"pose", PoseJson(bin.X_BN)}, {"size_m", bin.size_m}};
  return out;
}

}  // namespace tubetwin
