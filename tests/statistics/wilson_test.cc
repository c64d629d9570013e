#include "twin/statistics/wilson.h"

#include "models/base/error.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

constexpr double kPrinted = 5e-5;  // Published tables give four digits.

void Check(int k, int n, double low, double high) {
  INFO(k << " of " << n);
  CHECK(Wilson95(k, n).low == Approx(low).margin(kPrinted));
  CHECK(Wilson95(k, n).high == Approx(high).margin(kPrinted));
}

}  // namespace

TEST_CASE("the interval agrees with published values") {
  // Newcombe 1998, Statistics in Medicine 17:857-872, Table I, method 3.
  Check(81, 263, 0.2553, 0.3662);
  Check(15, 148, 0.0624, 0.1605);
  Check(0, 20, 0.0, 0.1611);
  Check(1, 29, 0.0061, 0.1718);
}

TEST_CASE("the interval gives the bounds that stand beside the paper's rates") {
  CHECK(Wilson95(6, 16).low == Approx(0.18).margin(0.005));
  CHECK(Wilson95(6, 16).high == Approx(0.61).margin(0.005));
  CHECK(Wilson95(0, 181).low == 0.0);
  CHECK(Wilson95(0, 181).high == Approx(0.02).margin(0.005));
}

TEST_CASE("success and failure mirror each other and the bounds stay within 0 and 1") {
  for (int n = 1; n <= 40; ++n) {
    for (int k = 0; k <= n; ++k) {
      const ShareInterval a = Wilson95(k, n);
      const ShareInterval b = Wilson95(n - k, n);
      CHECK(a.low == Approx(1.0 - b.high).margin(1e-12));
      CHECK((0.0 <= a.low && a.low <= a.high && a.high <= 1.0));
      CHECK((a.low <= static_cast<double>(k) / n && static_cast<double>(k) / n <= a.high));
    }
  }
}

TEST_CASE("no trial says nothing and impossible counts are a bug") {
  CHECK(Wilson95(0, 0).low == 0.0);
  CHECK(Wilson95(0, 0).high == 1.0);
  CHECK_THROWS_AS(Wilson95(3, 2), LogicError);
  CHECK_THROWS_AS(Wilson95(-1, 2), LogicError);
}

}  // namespace tubetwin
