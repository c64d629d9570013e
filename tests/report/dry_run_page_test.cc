#include "twin/report/dry_run_page.h"

#include "models/base/json.h"
#include "tests/report/report_fixture.h"
#include "tests/support/catch.h"

namespace tubetwin {
namespace {

using Catch::Contains;

DryRunStory Story() {
  DryRunStory story;
  story.scene.emplace();
  for (int i = 0; i < 3; ++i) {
    PerceivedTube tube;
    tube.id = i + 1;
    tube.centerline_N = {{0.1 * i, 0.0, 0.02}, {0.1 * i, 0.2, 0.02}};
    tube.tube_class = i == 2 ? TubeClass::kStrong : TubeClass::kFree;
    story.scene->tubes.push_back(tube);
  }
  story.plan.emplace();
  story.plan->target = 2;
  story.plan->motion.name = "up<b>";
  story.plan->grasp.X_NG = Translation(0.1, 0.0123, 0.0561);
  story.plan->grasp.opening_m = 0.04;
  story.checked = {{"Trajectories", "14"}, {"Sent", "nothing"}};
  story.told = "14 trajectories checked; nothing was sent";
  return story;
}

}  // namespace

TEST_CASE("a rehearsal says in a sentence what was seen and what would be done") {
  DryRunStory story = Story();
  CHECK(
      DryRunText(story) ==
      "saw 3 tubes (2 free, 1 strong); would take tube 2 (free) by motion up<b>, grasped at x 100, "
      "y 12, z 56 mm in the bin");
  story.plan.reset();
  story.end = "tube 3: no candidate";
  CHECK(DryRunText(story) ==
        "saw 3 tubes (2 free, 1 strong); would do nothing: tube 3: no candidate");
  story.scene.reset();
  CHECK_THAT(DryRunText(story), Contains("came to no look"));
}

TEST_CASE("a rehearsal's page leads with nothing was sent and draws what was seen") {
  const std::string html = Markup(DryRunHtml(Story(), StudySetup()));
  CHECK_THAT(html, Contains("<h1>Nothing was sent</h1>") && Contains("up&lt;b&gt;") &&
                       Contains("14 trajectories checked; nothing was sent."));
  CHECK(CountOf(html, "<polyline class=\"class0\"") == 2);
  CHECK(CountOf(html, "<polyline class=\"class2\"") == 1);
  CHECK(CountOf(html, "<circle class=\"grasp\"") == 1);
  CHECK(UnbalancedTags(html).empty());
  CHECK_THAT(html, !Contains("Placed"));
}

TEST_CASE("a rehearsal without a plan says why") {
  DryRunStory story = Story();
  story.plan.reset();
  story.end = "no plan <x>";
  const std::string html = Markup(DryRunHtml(story, StudySetup()));
  CHECK_THAT(html, Contains("Nothing: no plan &lt;x&gt;.") && !Contains("class=\"grasp\""));
}

}  // namespace tubetwin
