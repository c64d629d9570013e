#include "twin/statistics/wilson.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/normal.hpp>

#include "models/base/error.h"

namespace tubetwin {

ShareInterval Wilson95(int k, int n) {
  TT_CHECK(0 <= k && k <= n);
  if (n == 0) return {};
  return Wilson95OfShare(static_cast<double>(k) / n, n);
}

ShareInterval Wilson95OfShare(double share, double n) {
  TT_CHECK(0.0 <= share && share <= 1.0 && n > 0.0);
  static const double z = boost::math::quantile(boost::math::normal(), 0.975);
  const double scale = 1.0 + z * z / n;
  const double centre = (share + z * z / (2.0 * n)) / scale;
  const double half = z * std::sqrt(share * (1.0 - share) / n + z * z / (4.0 * n * n)) / scale;
  // Where none or all succeeded one bound is exact; rounding must not move it.
  return {share == 0.0 ? 0.0 : std::max(0.0, centre - half),
          share == 1.0 ? 1.0 : std::min(1.0, centre + half)};
}

}  // namespace tubetwin
