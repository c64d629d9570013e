#include "twin/report/dry_run_page.h"

#include <array>
#include <cmath>

#include "models/base/json.h"
#include "twin/report/front/part_picture.h"
#include "twin/report/page.h"
#include "twin/report/parts.h"
#include "twin/report/text.h"

namespace tubetwin {
namespace {

std::string Plural(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string Millimetres(double metres) { return std::to_string(std::lround(1e3 * metres)); }

std::string GraspText(const Grasp& grasp) {
  const Vector3& p_N = grasp.X_NG.translation();
  return "x " + Millimetres(p_N.x()) + ", y " + Millimetres(p_N.y()) + ", z " +
         Millimetres(p_N.z()) + " mm in the bin";
}

std::string SeenText(const TubeScene& scene) {
  std::array<int, 3> counts = {0, 0, 0};
  for (const PerceivedTube& tube : scene.tubes) ++counts[static_cast<int>(tube.tube_class)];
  std::string classes;
  for (const TubeClass one : {TubeClass::kFree, TubeClass::kWeak, TubeClass::kStrong}) {
    const int count = counts[static_cast<int>(one)];
    if (count == 0) continue;
    classes += (classes.empty() ? "" : ", ") + std::to_string(count) + " " + ToString(one);
  }
  return Plural(scene.tubes.size(), "tube") + (classes.empty() ? "" : " (" + classes + ")");
}

std::string FactRows(const FactTexts& facts) {
  std::string out = "<dl class=\"study\">\n";
  for (const auto& [name, text] : facts) {
    out += "<div><dt>" + Escaped(name) + "</dt><dd>" + Shown(text) + "</dd></div>\n";
  }
  return out + "</dl>\n";
}

FactTexts PlanFacts(const PickPlan& plan) {
  return {{"Tube", std::to_string(plan.target) + ", " + ToString(plan.target_class)},
          {"Motion", plan.motion.name},
          {"Grasp", GraspText(plan.grasp)},
          {"Fingers open to", Millimetres(plan.grasp.opening_m) + " mm"},
          {"Simulated first", plan.used_simulator ? "yes" : "no"}};
}

std::string SeenHtml(const DryRunStory& story) {
  if (!story.scene) return "<p>The rehearsal came to no look into the bin.</p>\n";
  std::vector<SeenTube> tubes;
  for (const PerceivedTube& tube : story.scene->tubes) {
    tubes.push_back({tube.centerline_N, static_cast<int>(tube.tube_class),
                     story.plan && story.plan->target == tube.id});
  }
  std::optional<Vector3> p_NG;
  if (story.plan) p_NG = story.plan->grasp.X_NG.translation();
  return Figure(SeenPictureSvg(tubes, p_NG, story.bin),
                "The bin from above: centerlines as perceived, the chosen one thick, a ring where "
                "it would be grasped. " +
                    Legend({{"class0", "free"}, {"class1", "weak"}, {"class2", "strong"}})) +
         FactRows({{"Seen", SeenText(*story.scene)},
                   {"Crossings", std::to_string(story.scene->crossings.size())},
                   {"Unexplained places", std::to_string(story.scene->unexplained_N.size())},
                   {"Bin", std::string(ToString(story.scene->bin_content)) + ": " +
                               story.scene->bin_content_reason}});
}

}  // namespace

std::string DryRunText(const DryRunStory& story) {
  std::string out = story.scene ? "saw " + SeenText(*story.scene) : "came to no look into the bin";
  if (!story.plan) return out + "; would do nothing: " + story.end;
  return out + "; would take tube " + std::to_string(story.plan->target) + " (" +
         ToString(story.plan->target_class) + ") by motion " + story.plan->motion.name +
         ", grasped at " + GraspText(story.plan->grasp);
}

std::string DryRunHtml(const DryRunStory& story, const StudySetup& setup) {
  std::string body =
      HeaderHtml("Dry run of one attempt", "Nothing was sent",
                 "Arm and gripper got no command: the motions below were planned, checked and "
                 "followed in thought. " +
                     Escaped(DryRunText(story)) + "; " + Escaped(story.told) + ".");
  body += "<div class=\"two\">" + Section("seen", "What was seen", SeenHtml(story)) + "<div>" +
          Section("plan", "What would be done",
                  story.plan ? FactRows(PlanFacts(*story.plan))
                             : "<p>Nothing: " + Escaped(story.end) + ".</p>\n") +
          Section("checked", "What was checked", FactRows(story.checked)) + "</div></div>\n" +
          Section("cell", "The cell", FactRows(StudyFacts(setup)));
  Json data{{"schema", "tubetwin/report/2"}, {"kind", "dry_run"}, {"figures", story.figures}};
  data.update(AttemptData({}));
  return ReportPage("tubetwin: dry run", body, data);
}

}  // namespace tubetwin
