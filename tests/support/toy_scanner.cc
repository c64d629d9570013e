#include "tests/support/toy_scanner.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

namespace tubetwin {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Smallest t > 0 with |o + t d - segment| = r, or infinity. d is a unit vector.
double HitCapsule(const Vector3& o, const Vector3& d, const Vector3& a, const Vector3& b,
                  double r) {
  const Vector3 axis = b - a;
  const double length = axis.norm();
  double best = kFar;
  if (length > 1e-12) {
    const Vector3 w = axis / length;
    const Vector3 m = o - a;
    const Vector3 dp = d - d.dot(w) * w, mp = m - m.dot(w) * w;
    const double A = dp.squaredNorm(), B = dp.dot(mp), C = mp.squaredNorm() - r * r;
    const double D = B * B - A * C;
    if (A > 1e-15 && D >= 0) {
      const double t = (-B - std::sqrt(D)) / A;
      const double s = (m + t * d).dot(w);
      if (t > 0 && s >= 0 && s <= length) best = t;
    }
  }
  for (const Vector3& c : {a, b}) {
    const Vector3 m = o - c;
    const double B = m.dot(d), D = B * B - m.squaredNorm() + r * r;
    if (D >= 0 && -B - std::sqrt(D) > 0) best = std::min(best, -B - std::sqrt(D));
  }
  return best;
}

double HitBox(const Vector3& o, const Vector3& d, const Vector3& low, const Vector3& high) {
  double near = 0.0, far = kFar;
  for (int i = 0; i < 3; ++i) {
    double t0 = (low[i] - o[i]) / d[i], t1 = (high[i] - o[i]) / d[i];
    if (t0 > t1) std::swap(t0, t1);
    near = std::max(near, t0);
    far = std::min(far, t1);
  }
  return near <= far ? near : kFar;
}

std::vector<ToyScene::Box> BinBoxes(const Bin& bin) {
  const double hx = bin.half_x_m(), hy = bin.half_y_m(), t = Bin::kWallThickness_m,
               h = bin.wall_m();
  return {{{hx, -hy - t, -0.02}, {hx + t, hy + t, h}},
          {{-hx - t, -hy - t, -0.02}, {-hx, hy + t, h}},
          {{-hx - t, hy, -0.02}, {hx + t, hy + t, h}},
          {{-hx - t, -hy - t, -0.02}, {hx + t, -hy, h}}};
}

struct Image {
  std::vector<double> range;
  std::vector<std::uint32_t> label;
};

/// Ranges along the pixel rays. Capsules are only tried in the part of the image that their
/// bounding spheres cover.
Image Cast(const ToyScene& scene, int width, int height, double focal, const RigidTransform& X_NS) {
  const auto n = static_cast<std::size_t>(width) * height;
  Image out{std::vector<double>(n, kFar), std::vector<std::uint32_t>(n, kLabelNone)};
  const double cx = 0.5 * (width - 1), cy = 0.5 * (height - 1);
  const Vector3 o = X_NS.translation();
  std::vector<ToyScene::Box> boxes = BinBoxes(scene.bin);
  boxes.insert(boxes.end(), scene.boxes.begin(), scene.boxes.end());
  boxes.push_back({{-1.5, -1.5, -0.02}, {1.5, 1.5, 0.0}});
  auto ray = [&](int i, int j) -> Vector3 {
    return X_NS.linear() * Vector3((i - cx) / focal, (j - cy) / focal, 1.0).normalized();
  };
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const std::size_t k = static_cast<std::size_t>(j) * width + i;
      for (const auto& box : boxes) {
        const double t = HitBox(o, ray(i, j), box.low_N, box.high_N);
        if (t < out.range[k]) {
          out.range[k] = t;
          out.label[k] = kLabelCell;
        }
      }
    }
  }
  for (std::size_t tube = 0; tube < scene.tubes_N.size(); ++tube) {
    for (const AxisPiece& piece : PiecesWithin(scene.tubes_N[tube], scene.radius_m)) {
      const Vector3& a = piece.from;
      const Vector3& b = piece.to;
      double u0 = 1e9, u1 = -1e9, v0 = 1e9, v1 = -1e9;
      bool behind = false;
      for (const Vector3& p_N : {a, b}) {
        const Vector3 p = X_NS.inverse() * p_N;
        behind |= p.z() < 0.1;
        const double u = focal * p.x() / p.z() + cx, v = focal * p.y() / p.z() + cy;
        const double reach = 1.5 * focal * scene.radius_m / p.z() + 2;
        u0 = std::min(u0, u - reach);
        u1 = std::max(u1, u + reach);
        v0 = std::min(v0, v - reach);
        v1 = std::max(v1, v + reach);
      }
      if (behind) continue;
      for (int j = std::max(0, static_cast<int>(v0)); j <= std::min(height - 1.0, v1); ++j) {
        for (int i = std::max(0, static_cast<int>(u0)); i <= std::min(width - 1.0, u1); ++i) {
          const double t = HitCapsule(o, ray(i, j), a, b, scene.radius_m);
          const std::size_t k = static_cast<std::size_t>(j) * width + i;
          if (t >= out.range[k]) continue;
          out.range[k] = t;
          out.label[k] = kLabelFirstTube + static_cast<std::uint32_t>(tube);
        }
      }
    }
  }
  return out;
}

}  // namespace

OrganizedCloud ToyScan(const ToyScene& scene, const ToyCamera& camera, const RigidTransform& X_NS,
                       RandomStream stream) {
  const Image image = Cast(scene, camera.width, camera.height, camera.focal_px, X_NS);
  const RigidTransform X_SP = Translation(camera.baseline_m, 0, 0);
  Image projector;
  const int pw = camera.width * 2, ph = camera.height;  // Lights all that the camera sees.
  if (camera.baseline_m != 0.0) {
    projector = Cast(scene, pw, ph, camera.focal_px, X_NS * X_SP);
  }
  OrganizedCloud cloud;
  cloud.width = camera.width;
  cloud.height = camera.height;
  cloud.X_NS = X_NS;
  cloud.p_SP.assign(image.range.size(), InvalidPoint());
  cloud.label = image.label;
  const double cx = 0.5 * (camera.width - 1), cy = 0.5 * (camera.height - 1);
  for (std::size_t k = 0; k < image.range.size(); ++k) {
    const double noise = camera.sigma_m * stream.Normal();
    const bool dropped = camera.drop_out > 0 && stream.Uniform() < camera.drop_out;
    if (image.range[k] == kFar || dropped) continue;
    const int i = static_cast<int>(k) % camera.width, j = static_cast<int>(k) / camera.width;
    const Vector3 ray =
        Vector3((i - cx) / camera.focal_px, (j - cy) / camera.focal_px, 1.0).normalized();
    if (camera.baseline_m != 0.0) {
      const Vector3 p = X_SP.inverse() * (image.range[k] * ray);
      const long u = std::lround(camera.focal_px * p.x() / p.z() + 0.5 * (pw - 1));
      const long v = std::lround(camera.focal_px * p.y() / p.z() + 0.5 * (ph - 1));
      if (u < 0 || v < 0 || u >= pw || v >= ph) continue;
      if (projector.range[static_cast<std::size_t>(v) * pw + u] < p.norm() - 0.003) continue;
    }
    cloud.p_SP[k] = ((image.range[k] + noise) * ray).cast<float>();
  }
  return cloud;
}

RigidTransform LookDown(const Vector3& p_NS) {
  Matrix3 R_NS;
  R_NS.col(0) = -Vector3::UnitY();
  R_NS.col(1) = -Vector3::UnitX();
  R_NS.col(2) = -Vector3::UnitZ();
  return MakeTransform(R_NS, p_NS);
}

std::vector<RigidTransform> EightPoses() {
  std::vector<RigidTransform> out;
  for (const double x : {-0.29, -0.10, 0.10, 0.29}) {
    for (const double y : {-0.145, 0.145}) out.push_back(LookDown({x, y, 0.515}));
  }
  return out;
}

RigidTransform Disturbed(const RigidTransform& X, double shift_m, double turn_rad,
                         RandomStream& stream) {
  auto direction = [&stream]() -> Vector3 {
    return Vector3(stream.Normal(), stream.Normal(), stream.Normal()).normalized();
  };
  const Vector3 shift = shift_m * direction();
  const Vector3 axis = direction();
  return X * MakeTransform(Eigen::AngleAxisd(turn_rad, axis).toRotationMatrix(), shift);
}

std::vector<Polyline> ReadPublicPile(const std::string& name) {
  std::ifstream file(std::string(TUBETWIN_SOURCE_DIR) + "/../shared/data/leao2022/" + name +
                     ".csv");
  std::map<int, Polyline> tubes;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream in(line);
    int tube = 0, index = 0;
    Vector3 p;
    if (in >> tube >> index >> p.x() >> p.y() >> p.z()) tubes[tube].push_back(p);
  }
  std::vector<Polyline> out;
  for (auto& [id, curve] : tubes) out.push_back(curve);
  return out;
}

}  // namespace tubetwin
