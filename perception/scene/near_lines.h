#pragma once

#include <vector>

#include "models/base/polyline.h"

namespace tubetwin {

/// Curves prepared for fast queries of the distance to the nearest of them, up to a limit. Keeps
/// copies. Thread safe.
class NearLines {
 public:
  /// Adds a curve; curves are numbered from 0 in the order of these calls. It may be empty.
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
