#include "twin/app/dry_run_verb.h"

#include <cstdio>
#include <filesystem>

#include "models/base/files.h"
#include "models/base/json.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

std::string FormatText(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

FactTexts CheckedFacts(const DryRunReport& report) {
  const auto& near = report.nearest;
  const auto& joint = report.slowest_joint;
  FactTexts out = {{"Trajectories", std::to_string(report.trajectories) + ", " +
                                        FormatText("%.1f s of motion", report.duration_s)},
                   {"Commands to the gripper", std::to_string(report.gripper_commands)}};
  if (report.trajectories > 0) {
    out.emplace_back("Least clearance",
                     near.is_beyond ? FormatText("above %.0f mm", 1e3 * near.clearance_m)
                                    : FormatText("%.1f mm", 1e3 * near.clearance_m) + ", " +
                                          near.moving + " to " + near.obstacle +
                                          ", in trajectory " + std::to_string(near.trajectory) +
                                          FormatText(" after %.1f s", near.at_s));
    out.emplace_back("Slowest joint",
                     std::to_string(joint.joint) + " (" + joint.name +
                         "): " + FormatText("%.0f", Degrees(joint.speed_rad_s)) +
                         FormatText(" of %.0f deg/s, the nearest to its limit, in trajectory ",
                                    Degrees(joint.limit_rad_s)) +
                         std::to_string(joint.trajectory));
  }
  out.emplace_back("Sent", "nothing");
  return out;
}

}  // namespace

DryRun RunDry(Cell& real, const Scenario& scenario, RoundOptions options) {
  DryRun out;
  out.story.bin = real.bin;
  options.write_report = nullptr;  // A rehearsal has a page of its own.
  options.on_scene = [&out](const TubeScene& scene, const PickPlan* plan) {
    out.story.scene = scene;
    out.story.plan = plan != nullptr ? std::optional<PickPlan>(*plan) : std::nullopt;
  };
  int attempts = 0;  // The stop is asked for before each: one is enough to see what would be done.
  const auto stop_requested = options.stop_requested;
  options.stop_requested = [&attempts, stop_requested] {
    return attempts++ > 0 || (stop_requested && stop_requested());
  };
  const Part part = LoadPart(ScenarioPartName(scenario));
  DryRunCell dry(real, {2.0 * part.radius_m, part.mass_kg});
  out.round = RunCellRound(dry.cell(), scenario, options);
  out.report = dry.Report();
  out.story.end = out.round.record.summary.end_detail;
  out.story.checked = CheckedFacts(out.report);
  out.story.told = ToText(out.report);
  out.story.figures = ToJson(out.report);
  const fs::path folder(options.out_folder);
  WriteJsonFile(out.story.figures, (folder / "dry_run.json").string());
  WriteFileAtomically((folder / "report.html").string(),
                      DryRunHtml(out.story, SetupOfRound(folder.string())));
  return out;
}

}  // namespace tubetwin
