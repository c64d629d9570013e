#pragma once

namespace tubetwin {

/// Bounds of a share, each in [0, 1].
struct ShareInterval {
  double low = 0.0;
  double high = 1.0;
};

/// 95 % interval of the chance of success after k successes in n trials (Wilson 1927, without
/// continuity correction). n = 0 says nothing: [0, 1]. Precondition: 0 <= k <= n.
ShareInterval Wilson95(int k, int n);

/// The same of a share in [0, 1] of `n` trials, where n is a size that dependent trials are worth
/// and no whole number. Precondition: n > 0.
ShareInterval Wilson95OfShare(double share, double n);

}  // namespace tubetwin
