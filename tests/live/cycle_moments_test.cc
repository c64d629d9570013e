#include "twin/live/cycle_moments.h"

#include "models/arm/arm.h"
#include "tests/support/catch.h"
#include "tests/support/paper_cell.h"

namespace tubetwin {
namespace {

/// Looks of an arm whose E is at a point of N, tool down.
struct Looks {
  CycleMoments::Look At(double x, double y, double z) const {
    const RigidTransform X_NE = MakeTransform(RotX(kPi), Vector3(x, y, z));
    const RigidTransform X_BF = bin.X_BN * X_NE * layout.X_FE.inverse();
    const auto solutions = InverseAll(PaperCell().arm, X_BF);
    REQUIRE_FALSE(solutions.empty());
    CycleMoments::Look look;
    look.q = solutions.front();
    look.fingers_in_use = true;
    look.fingers.opening_m = look.fingers.requested_m = PaperCell().gripper.stroke_m;
    return look;
  }
  Bin bin;
  const CellLayout& layout = PaperCell().layout;
};

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("A pick shows its moments in order, once each", "[unit]") {
  const Looks looks;
  CycleMoments moments(PaperCell(), looks.bin);
  CHECK(moments.After(looks.At(0, 0, 0.4)).empty());
  auto look = looks.At(0, 0, 0.4);
  look.scans = 2;
  CHECK(moments.After(look) == Names{"scan", "scan"});
  look.fingers.requested_m = 0.05;  // Pre-opening high over the bin.
  CHECK(moments.After(look).empty());
  const auto at = [&](double x, double y, double z, double requested_m, GripperObject object) {
    CycleMoments::Look next = looks.At(x, y, z);
    next.scans = 2;
    next.fingers.requested_m = requested_m;
    next.fingers.object = object;
    return moments.After(next);
  };
  CHECK(at(0, 0, 0.15, 0.05, GripperObject::kAtPosition) == Names{"reach"});
  CHECK(at(0, 0, 0.02, 0.05, GripperObject::kAtPosition).empty());
  CHECK(at(0, 0, 0.02, 0.0, GripperObject::kMoving) == Names{"close"});
  CHECK(at(0, 0, 0.02, 0.0, GripperObject::kContactClosing) == Names{"held"});
  CHECK(at(0, 0, 0.3, 0.0, GripperObject::kContactClosing) == Names{"lift"});
  CHECK(at(0, -0.4, 0.3, 0.0, GripperObject::kContactClosing) == Names{"carry"});
  CHECK(at(0, -0.4, 0.3, 0.0, GripperObject::kContactClosing).empty());
  CHECK(at(0, -0.4, 0.3, 0.04, GripperObject::kMoving) == Names{"open"});
  for (const std::string& name : CycleMoments::Names()) {
    CAPTURE(name);
    CHECK(moments.count(name) == (name == "scan" ? 2 : 1));
  }
}

TEST_CASE("What the fingers do before they are activated is no moment", "[unit]") {
  const Looks looks;
  CycleMoments moments(PaperCell(), looks.bin);
  CycleMoments::Look look = looks.At(0, 0, 0.02);
  look.fingers_in_use = false;
  moments.After(look);
  look.fingers.requested_m = 0.0;
  look.fingers.object = GripperObject::kContactClosing;
  CHECK(moments.After(look).empty());
  look.fingers.requested_m = 0.085;
  CHECK(moments.After(look).empty());
}

}  // namespace tubetwin
