#include "twin/live/live_clock.h"

#include <algorithm>
#include <utility>

namespace tubetwin {
namespace {

/// Each time round the twin has less to catch up with, if it is faster than the wall.
constexpr int kRounds = 4;

}  // namespace

void LiveClock::Keep(CellClock& twin, std::function<void()> before_period) {
  twin_ = &twin;
  before_period_ = std::move(before_period);
}

void LiveClock::AdvanceTo(TimeNs t) {
  CatchUp();
  while (twin_ != nullptr && twin_->Now() < t) {
    const TimeNs next = std::min(t, twin_->Now() + kControlPeriod);
    wall_.AdvanceTo(next);
    Step(next);
  }
  wall_.AdvanceTo(t);
}

void LiveClock::CatchUp() {
  for (int round = 0; twin_ != nullptr && round < kRounds; ++round) {
    const TimeNs now = wall_.Now();
    if (now - twin_->Now() < kControlPeriod) return;
    while (now - twin_->Now() >= kControlPeriod) Step(twin_->Now() + kControlPeriod);
  }
}

void LiveClock::Step(TimeNs to) {
  if (before_period_) before_period_();
  twin_->AdvanceTo(to);
}

}  // namespace tubetwin
