#include "twin/round/round_recorder.h"

#include "tests/support/catch.h"

namespace tubetwin {
namespace {

/// A view from `height_m` straight down on (x, y) of frame N with `count` points around p_N.
OrganizedCloud ViewOf(const Vector3& p_N, int count) {
  OrganizedCloud view;
  view.X_NS = MakeTransform(RotX(kPi), Vector3(0.1, -0.2, 0.8));
  const Vector3 p_S = view.X_NS.inverse() * p_N;
  for (int i = 0; i < count; ++i) {
    view.p_SP.push_back((p_S + Vector3(0.001 * i, 0, 0)).cast<float>());
  }
  view.p_SP.push_back(InvalidPoint());
  view.width = static_cast<int>(view.p_SP.size());
  view.height = 1;
  return view;
}

TEST_CASE("A failure keeps the view that shows most of what was to be grasped", "[unit]") {
  const Vector3 grasp_N(0.05, 0.03, 0.02);
  AttemptRecord attempt;
  attempt.chosen.emplace();
  attempt.chosen->p_NG = grasp_N;
  // The second looks elsewhere, however much it sees there.
  const std::vector<OrganizedCloud> views = {ViewOf(grasp_N, 3), ViewOf({0.3, 0.2, 0.0}, 40),
                                             ViewOf(grasp_N, 9), ViewOf(grasp_N, 9)};
  CHECK(ViewsOfFailure(views, attempt) == std::vector<std::size_t>{2});
}

TEST_CASE("Without a plan every view may be why, and without a view there is none", "[unit]") {
  AttemptRecord attempt;
  const std::vector<OrganizedCloud> views = {ViewOf({0, 0, 0}, 3), ViewOf({0, 0, 0}, 4)};
  CHECK(ViewsOfFailure(views, attempt) == std::vector<std::size_t>{0, 1});
  attempt.chosen.emplace();
  CHECK(ViewsOfFailure({}, attempt).empty());
}

}  // namespace
}  // namespace tubetwin
