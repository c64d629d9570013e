#pragma once

#include <vector>

#include "models/bin.h"
#include "perception/fragment/fragments.h"
#include "perception/view/view_image.h"

namespace tubetwin {

/// A bridge whose bending energy times its squared gap is kEven_m less kStraightest_m is as often
/// true as false: for an arc, its turn squared times the gap.
inline constexpr double kEven_m = 0.097, kStraightest_m = 0.018;

/// Says whether a tube can pass where no part of it was found: hidden behind something, or where no
/// view looks. Keeps references: views and bin must outlive it. Thread safe.
class OccludedSpace {
 public:
  OccludedSpace(const std::vector<ViewImage>& views, const Bin& bin, double radius_m);

  /// What all views together say about one point of an axis: the strongest statement of any view,
  /// in the order of Visibility.
  Visibility Query(const Vector3& p_N) const;

  /// Whether a tube's axis may pass here as far as floor and walls are concerned.
  bool FitsBin(const Vector3& p_N) const;

  double radius_m() const { return radius_m_; }

 private:
  const std::vector<ViewImage>& views_;
  const Bin& bin_;
  double radius_m_;
};

/// A curve that may connect the ends of two fragments of the same tube through occluded space.
struct Bridge {
  int end_a = 0, end_b = 0;  ///< 2 * fragment + end.
  Polyline line_N;           ///< Both ends included, nodes at most kNodeStep_m apart.
  double length_m = 0.0;
  /// Negative log-odds (nats) that the two belong together, from the bending and the length of the
  /// gap, the share of it that no view confirms as occluded, and the caps seen at its ends. Below
  /// 0: more likely than not.
  double cost = 0.0;
};

/// All bridges, at most `longest_m` long, that are possible: no view sees through any part of them,
/// they keep clear of all other fragments, and they stay inside the bin.
std::vector<Bridge> FindBridges(const std::vector<Fragment>& fragments, const OccludedSpace& space,
                                double longest_m);

}  // namespace tubetwin
