#pragma once

#include <array>
#include <string>
#include <vector>

#include "perception/calibration/calibration.h"
#include "perception/view/bin_planes.h"

namespace tubetwin::calibration_internal {

/// A point of a view with the normal of the surface there, frame S.
struct SurfacePoint {
  Vector3 p_S, n_S;
};

/// Points on a lattice of the view's image.
std::vector<SurfacePoint> SurfacePointsOf(const OrganizedCloud& cloud);

/// What the solver may change.
enum class Unknown {
  kBinLevel,  ///< The bin's place and yaw.
  kBin,       ///< The bin's whole pose.
  kScanner,   ///< The scanner, and the bin's whole pose with it.
};

/// Points that belong to one plane: of one view, or one touch (then frame B).
struct PlanePoints {
  std::size_t source = 0;  ///< Views first, then touches.
  bool seen = false;       ///< Of a view.
  std::size_t plane = 0;
  std::vector<Vector3> points;
};

/// Where everything is at some moment of the search.
struct Estimate {
  RigidTransform X_FS = RigidTransform::Identity();
  RigidTransform X_NB = RigidTransform::Identity();
  Eigen::Vector2d longer_m = Eigen::Vector2d::Zero();  ///< Of the bin than said, along x and y.
};

/// What an estimate consists of: the scanner (shift and turn in S), the bin (likewise, in N), its
/// sizes along x and y. Turns are multiplied by kLever_m.
inline constexpr int kNumbers = 14, kFirstOfBin = 6, kFirstOfSize = 12;
using Numbers = Eigen::Matrix<double, kNumbers, 1>;
using InformationMatrix = Eigen::Matrix<double, kNumbers, kNumbers>;

/// Least squares over planes, with points given to planes anew in every step. Keeps references.
class PlaneSolver {
 public:
  PlaneSolver(const CalibrationInput& input, const std::vector<std::vector<SurfacePoint>>& points);

  /// From `start` to where no step makes it better.
  Estimate Solve(const Estimate& start, Unknown unknown) const;

  /// The points of each plane there, groups of too few left out.
  std::vector<PlanePoints> Assign(const Estimate& at) const;
  /// Of all surface points, the share that lies inside the bin, far from floor and walls.
  double ShareInside(const Estimate& at) const;
  /// Distances of a group from its plane.
  std::vector<double> Distances(const PlanePoints& group, const Estimate& at) const;

  /// Inverse covariance of all numbers.
  InformationMatrix Information(const std::vector<PlanePoints>& groups, const Estimate& at) const;

 private:
  /// How points find their planes in one step: how far off, how aligned (cosine) they may be, and
  /// from what residual on they count less (0: never).
  struct Pass {
    double gate_m, aligned, scale_m;
  };
  static const std::vector<Pass>& Passes();
  std::vector<PlanePoints> Assign(const Estimate& at, const Pass& pass) const;
  std::size_t PlaneOf(const Vector3& p_N, const Vector3& n_N, const Pass& pass) const;
  std::size_t PlaneOfTouch(const CalibrationTouch& touch, const RigidTransform& X_NB) const;
  /// Distance of a point of a group from its plane, and how it changes with each number.
  double Distance(const PlanePoints& group, const Vector3& p, const Estimate& at,
                  Numbers& change) const;
  /// Normal equations; `scale_m`: from where on residuals count less, 0: nowhere.
  void Linearize(const std::vector<PlanePoints>& groups, const Estimate& at, double scale_m,
                 InformationMatrix& H, Numbers& g) const;

  const CalibrationInput& input_;
  const std::vector<std::vector<SurfacePoint>>& points_;
  const BinPlanes planes_;
};

/// How well a plane of a view, and a touch, are known.
inline constexpr double kPlaneSigma_m = 0.0001, kTouchSigma_m = 0.0003;

/// How well a bin's sizes are known: walls bend, and a tape is read to a millimetre.
inline constexpr double kSizeSigma_m = 0.0005;

/// A turn counts by how far it moves a point this far away.
inline constexpr double kLever_m = 0.3;

/// Which of the numbers are looked for.
std::vector<int> ActiveNumbers(Unknown unknown);

/// One sigma of the scanner's or the bin's pose in the direction known least; huge when nothing
/// tells it.
double WorstSigma(const InformationMatrix& information, Unknown unknown);

}  // namespace tubetwin::calibration_internal
