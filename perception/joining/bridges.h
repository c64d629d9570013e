#pragma once

#include <vector>

#include "models/bin.h"
#include "perception/fragment/fragments.h"
#include "perception/view/view_image.h"

namespace tubetwin {

/// Tests whether a piece of tube can be where nothing of it was segmented. Keeps references: views
/// and bin must outlive it. Thread safe.
class HiddenSpace {
 public:
  HiddenSpace(const std::vector<ViewImage>& views, const Bin& bin, double radius_m);

  /// What all views together say about one axis point: seen through in any view wins, then a
  /// surface, hidden, unknown; outside when no view reaches there.
  Sight Look(const Vector3& p_N) const;

  /// Whether a tube's axis may pass here as far as floor and walls are concerned.
  bool FitsBin(const Vector3& p_N) const;

  double radius_m() const { return radius_m_; }

 private:
  const std::vector<ViewImage>& views_;
  const Bin& bin_;
  double radius_m_;
};

/// A way from one fragment's end to another's through what was not seen.
struct Bridge {
  int end_a = 0, end_b = 0;  ///< 2 * fragment + end.
  Polyline line_N;           ///< Both ends included, nodes at most kNodeStep_m apart.
  double length_m = 0.0;
  /// Negative log-odds (nats) that it is true: bending, gap, what the views do not confirm, closed
  /// ends. Below 0: more likely true than not.
  double cost = 0.0;
};

/// All bridges that nothing forbids: along the whole way no view sees past it, it keeps off the
/// axes of all other fragments, and it stays in the bin.
std::vector<Bridge> FindBridges(const std::vector<Fragment>& fragments, const HiddenSpace& space,
                                double longest_m);

}  // namespace tubetwin
