#include "twin/render/cell_track.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "models/base/error.h"
#include "scenes/engine/engine_error.h"
#include "scenes/engine/mj_handles.h"
#include "twin/render/cell_xml.h"

namespace tubetwin {
namespace {

// What the eye does not miss, at the end of a capsule too.
constexpr double kStill_m = 3e-4, kStill_rad = 3e-3;

MjModel CompileCell(const Recording& recording) {
  const MjSpec spec = ParseCellXml(recording.cell_xml, recording.source);
  try {
    return Compile(*spec, recording.source);
  } catch (const Error& problem) {
    throw Error(ErrorKind::kBadData, problem.what());
  }
}

RigidTransform Pose(const mjtNum* pos, const mjtNum* quat) {
  RigidTransform X = RigidTransform::Identity();
  X.translation() = Vector3(pos[0], pos[1], pos[2]);
  X.linear() =
      Eigen::Quaterniond(quat[0], quat[1], quat[2], quat[3]).normalized().toRotationMatrix();
  return X;
}

std::optional<CellTrack::Shape> ShapeOf(int type) {
  switch (type) {
    case mjGEOM_BOX:
      return CellTrack::Shape::kBox;
    case mjGEOM_SPHERE:
      return CellTrack::Shape::kSphere;
    case mjGEOM_CAPSULE:
      return CellTrack::Shape::kCapsule;
    case mjGEOM_CYLINDER:
      return CellTrack::Shape::kCylinder;
    default:
      return std::nullopt;
  }
}

/// Bodies with geoms in the model's order. Returns the model's index of each.
std::vector<int> AddShapes(const mjModel& model, CellTrack& track) {
  std::vector<int> bodies;
  for (int g = 0; g < model.ngeom; ++g) {
    const auto shape = ShapeOf(model.geom_type[g]);
    if (!shape) continue;
    const int body = model.geom_bodyid[g];
    auto at = std::find(bodies.begin(), bodies.end(), body);
    if (at == bodies.end()) {
      const char* name = mj_id2name(&model, mjOBJ_BODY, body);
      track.bodies.push_back({name != nullptr ? name : "", {}});
      at = bodies.insert(bodies.end(), body);
    }
    CellTrack::Geom geom;
    geom.body = static_cast<int>(at - bodies.begin());
    const char* name = mj_id2name(&model, mjOBJ_GEOM, g);
    geom.name = name != nullptr ? name : "";
    geom.shape = *shape;
    for (int k = 0; k < 3; ++k) geom.size_m[k] = model.geom_size[3 * g + k];
    geom.X_bodyGeom = Pose(model.geom_pos + 3 * g, model.geom_quat + 4 * g);
    for (int k = 0; k < 4; ++k) geom.rgba[k] = model.geom_rgba[4 * g + k];
    track.geoms.push_back(geom);
  }
  return bodies;
}

bool IsSame(const RigidTransform& a, const RigidTransform& b) {
  return (a.translation() - b.translation()).norm() < kStill_m &&
         Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle() < kStill_rad;
}

/// Keeps a pose when it moved; the sample before a movement after a rest too, so that the rest
/// stays one when poses are interpolated.
class KeyWriter {
 public:
  explicit KeyWriter(std::vector<CellTrack::Key>& keys) : keys_(keys) {}
  void Add(int sample, const RigidTransform& X) {
    if (!keys_.empty() && IsSame(keys_.back().X_BBody, X)) return;
    if (!keys_.empty() && keys_.back().sample < sample - 1) {
      keys_.push_back({sample - 1, keys_.back().X_BBody});
    }
    keys_.push_back({sample, X});
  }

 private:
  std::vector<CellTrack::Key>& keys_;
};

RigidTransform PoseAt(const std::vector<CellTrack::Key>& keys, int sample) {
  const auto after =
      std::upper_bound(keys.begin(), keys.end(), sample,
                       [](int s, const CellTrack::Key& key) { return s < key.sample; });
  return after == keys.begin() ? keys.front().X_BBody : std::prev(after)->X_BBody;
}

}  // namespace

CellTrack TrackOf(const Recording& recording, int from, int to, int stride) {
  TT_CHECK(stride >= 1 && 0 <= from && from <= to &&
           to <= static_cast<int>(recording.frames.size()));
  const MjModel model = CompileCell(recording);
  const MjData data = MakeData(*model);
  CellTrack track;
  track.sample_s = static_cast<double>(stride) / Recording::kFramesPerSecond;
  const std::vector<int> bodies = AddShapes(*model, track);
  std::vector<KeyWriter> writers;
  for (CellTrack::Body& body : track.bodies) writers.emplace_back(body.keys);
  const int left = mj_name2id(model.get(), mjOBJ_GEOM, "pad_left");
  const int right = mj_name2id(model.get(), mjOBJ_GEOM, "pad_right");

  for (int frame = from; frame < to; frame += stride, ++track.samples) {
    const std::vector<float>& qpos = recording.frames[frame].qpos;
    if (qpos.size() != static_cast<std::size_t>(model->nq)) {
      throw Error(ErrorKind::kBadData, recording.source + ": frame " + std::to_string(frame) +
                                           " has " + std::to_string(qpos.size()) +
                                           " coordinates, its cell has " +
                                           std::to_string(model->nq));
    }
    std::copy(qpos.begin(), qpos.end(), data->qpos);
    GuardEngine([&] {
      mj_normalizeQuat(model.get(), data->qpos);  // Single precision in the file.
      mj_kinematics(model.get(), data.get());
    });
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      writers[i].Add(track.samples, Pose(data->xpos + 3 * bodies[i], data->xquat + 4 * bodies[i]));
    }
    if (left >= 0 && right >= 0) {
      const Eigen::Map<const Vector3> a(data->geom_xpos + 3 * left);
      const Eigen::Map<const Vector3> b(data->geom_xpos + 3 * right);
      track.p_BPs.push_back(0.5 * (a + b));
    }
  }
  return track;
}

std::vector<Polyline> TubesAt(const CellTrack& track, int sample) {
  std::vector<Polyline> tubes;
  std::vector<std::string> names;
  struct Piece {
    std::size_t tube;
    int number;
    Vector3 a, b;
  };
  std::vector<Piece> pieces;
  for (const CellTrack::Geom& geom : track.geoms) {
    const std::size_t at = geom.name.rfind("_g");
    if (geom.shape != CellTrack::Shape::kCapsule || at == std::string::npos ||
        geom.name.rfind("tube", 0) != 0 || track.bodies[geom.body].keys.empty()) {
      continue;
    }
    const std::string name = geom.name.substr(0, at);
    auto known = std::find(names.begin(), names.end(), name);
    if (known == names.end()) known = names.insert(names.end(), name);
    const RigidTransform X_BG = PoseAt(track.bodies[geom.body].keys, sample) * geom.X_bodyGeom;
    const Vector3 half(0, 0, geom.size_m[1]);
    pieces.push_back({static_cast<std::size_t>(known - names.begin()),
                      std::atoi(geom.name.c_str() + at + 2), X_BG * (-half), X_BG * half});
  }
  std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& x, const Piece& y) {
    return x.tube != y.tube ? x.tube < y.tube : x.number < y.number;
  });
  tubes.resize(names.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Piece& piece = pieces[i];
    Polyline& line = tubes[piece.tube];
    if (line.empty()) {  // It begins at the end that the next piece is farther from.
      const bool follows = i + 1 < pieces.size() && pieces[i + 1].tube == piece.tube;
      const Vector3 next = follows ? 0.5 * (pieces[i + 1].a + pieces[i + 1].b) : piece.b;
      line.push_back((piece.a - next).norm() > (piece.b - next).norm() ? piece.a : piece.b);
    }
    const Vector3 end = line.back();
    line.push_back((piece.a - end).norm() > (piece.b - end).norm() ? piece.a : piece.b);
  }
  return tubes;
}

}  // namespace tubetwin
