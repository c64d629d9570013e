#pragma once

#include <vector>

#include "models/base/polyline.h"

namespace tubetwin {

/// Many curves made ready for the question how near the nearest of them is, when only near ones
/// matter. Keeps references to nothing. Thread safe.
class NearLines {
 public:
  /// Adds a curve; curves are numbered in the order of this call. An empty one is near to nothing.
  void Add(const Polyline& line);

  /// Distance of `p` to the nearest curve but those numbered `except_a` and `except_b`, or
  /// `limit_m` when all are further away.
  double Distance(const Vector3& p, double limit_m, int except_a = -1, int except_b = -1) const;

 private:
  struct Piece {
    Vector3 start, step;
    double inverse;  ///< 1 / |step|^2.
  };
  /// A few successive pieces of one curve in a box.
  struct Group {
    int line;
    std::size_t first, last;  ///< Of pieces_, the latter excluded.
    Vector3 low, high;
  };
  std::vector<Piece> pieces_;
  std::vector<Group> groups_;
  int lines_ = 0;
};

}  // namespace tubetwin
