#include "hw_bridge/cell/wall_clock.h"

#include <thread>

#include "tests/support/catch.h"

namespace tubetwin {
namespace {

TEST_CASE("The wall clock is where it was told to go to, at any rate", "[unit]") {
  for (const double rate : {0.5, 1.0, 7.3}) {
    WallClock clock(rate);
    for (const double t_s : {0.002, 0.003, 0.0101}) {
      clock.AdvanceTo(FromSeconds(t_s));
      CHECK(clock.Now() >= FromSeconds(t_s));
    }
    const TimeNs before = clock.Now();
    clock.AdvanceTo(TimeNs(0));  // A time in the past does nothing.
    CHECK(clock.Now() >= before);
  }
}

TEST_CASE("A fast clock passes its time in a fraction of the wall's", "[unit]") {
  WallClock fast(1000.0), wall(1.0);
  fast.AdvanceTo(FromSeconds(10.0));
  CHECK(wall.Now() >= FromSeconds(0.0099));
  CHECK(fast.Now() >= FromSeconds(10.0));
}

TEST_CASE("A pace that is kept has no overrun", "[unit]") {
  Pace pace(1.0, FromSeconds(10.0));
  const TimeNs due = pace.Due(TimeNs(0));
  CHECK(due >= TimeNs(0));
  CHECK(pace.overruns() == 0);
  CHECK(pace.Until(due + FromSeconds(5.0)) > FromSeconds(0.0));
  CHECK(pace.Until(TimeNs(0)) == std::chrono::nanoseconds(0));
}

TEST_CASE("A pace that cannot be kept gives in, counts it and says how far it was behind",
          "[unit]") {
  Pace pace(100.0, FromSeconds(0.1));
  std::this_thread::sleep_for(std::chrono::milliseconds(5));  // 0.5 s of the cell's time.
  const TimeNs due = pace.Due(TimeNs(0));
  CHECK(pace.overruns() == 1);
  CHECK(pace.worst_lag() >= FromSeconds(0.5));
  CHECK(pace.given_in() >= FromSeconds(0.5));
  CHECK(due < pace.worst_lag());  // What is behind is not caught up.
}

}  // namespace
}  // namespace tubetwin
