#include "perception/scene/near_lines.h"

#include <algorithm>
#include <cmath>

namespace tubetwin {

void NearLines::Add(const Polyline& line) {
  constexpr std::size_t kPiecesPerGroup = 8;
  const int number = lines_++;
  if (line.empty()) return;
  const std::size_t pieces = std::max<std::size_t>(1, line.size() - 1);
  for (std::size_t k = 0; k < pieces; ++k) {
    const Vector3& a = line[k];
    const Vector3& b = line[std::min(k + 1, line.size() - 1)];
    if (k % kPiecesPerGroup == 0) {
      groups_.push_back({number, pieces_.size(), pieces_.size(), a, a});
    }
    Group& group = groups_.back();
    pieces_.push_back({a, b - a, 1.0 / std::max((b - a).squaredNorm(), 1e-18)});
    group.last = pieces_.size();
    group.low = group.low.cwiseMin(b);
    group.high = group.high.cwiseMax(b);
  }
}

double NearLines::Distance(const Vector3& p, double limit_m, int except_a, int except_b) const {
  double best = limit_m * limit_m;
  for (const Group& group : groups_) {
    if (group.line == except_a || group.line == except_b) continue;
    const Vector3 outside = (group.low - p).cwiseMax(p - group.high).cwiseMax(0.0);
    if (outside.squaredNorm() >= best) continue;
    for (std::size_t k = group.first; k < group.last; ++k) {
      const Piece& piece = pieces_[k];
      const Vector3 w = p - piece.start;
      const double u = std::clamp(w.dot(piece.step) * piece.inverse, 0.0, 1.0);
      best = std::min(best, (w - u * piece.step).squaredNorm());
    }
  }
  return std::sqrt(best);
}

}  // namespace tubetwin
