#include "twin/report/front/study_setup.h"

#include <filesystem>

#include "models/base/error.h"
#include "models/base/random.h"
#include "twin/round/scenario.h"

namespace tubetwin {
namespace fs = std::filesystem;
namespace {

constexpr int kShapesDrawn = 3;  ///< Of a part whose pieces are not all alike.

void AddShapes(std::uint64_t seed, StudySetup& setup) {
  const Part& part = *setup.part;
  if (part.shape == "fixed") {
    setup.shapes.push_back(part.centerline());
    return;
  }
  RandomStream stream(seed, 0, "shapes of a report");
  for (int i = 0; i < kShapesDrawn; ++i) setup.shapes.push_back(DrawShape(part, stream));
}

Json ConfigOf(Scenario scenario) {
  return Json::parse(WriteConfigJson([&scenario](ConfigVisitor& v) { scenario.Visit(v); }));
}

}  // namespace

std::vector<StudySetup> SetupsOf(const CampaignIdentity& identity) {
  const char* list = identity.document.contains("variants") ? "variants" : "arms";
  const JsonView document(identity.document, "campaign.json");
  std::vector<StudySetup> out;
  for (std::size_t i = 0; i < identity.variants.size(); ++i) {
    const JsonView variant = document.Field(list).Item(i);
    StudySetup setup;
    setup.name = identity.variants[i];
    if (const auto part = variant.Optional("part")) setup.part = PartFromJson(*part);
    if (const auto tubes = variant.Optional("tubes")) {
      setup.tubes = static_cast<int>(tubes->AsInteger());
    }
    if (const auto config = variant.Optional("config")) setup.config = config->json();
    if (setup.part) AddShapes(static_cast<std::uint64_t>(identity.seed), setup);
    out.push_back(std::move(setup));
  }
  return out;
}

StudySetup SetupOfRound(const std::string& folder) {
  StudySetup setup;
  setup.name = "this round";
  const fs::path config = fs::path(folder) / "config.resolved.toml";
  if (fs::exists(config)) {
    try {
      ConfigSource source;
      source.AddFile(config.string());
      const Scenario scenario = ReadScenario(source);
      setup.config = ConfigOf(scenario);
      setup.tubes = scenario.pile.count;
      setup.config.erase("seed");
      setup.seed = scenario.seed;
    } catch (const Error& error) {
      // Another version's keys: what they meant is not known here, the rows are read all the same.
      if (error.kind() != ErrorKind::kConfig) throw;
    }
  }
  AddStartPile(folder, setup);
  if (setup.part) AddShapes(1, setup);
  return setup;
}

void AddStartPile(const std::string& folder, StudySetup& setup) {
  const fs::path file = fs::path(folder) / "start.pile.json";
  if (!setup.pile_N.empty() || !fs::exists(file)) return;
  const Pile pile = LoadPile(file.string());
  if (!setup.part) setup.part = pile.part;
  setup.bin = pile.bin;
  setup.tubes = static_cast<int>(pile.tubes.size());
  for (const PileTube& tube : pile.tubes) setup.pile_N.push_back(tube.centerline_N);
}

Json KeyOf(const StudySetup& setup, const std::string& path) {
  const Json::json_pointer at("/" + path);
  return setup.config.is_object() && setup.config.contains(at) ? setup.config.at(at) : Json();
}

}  // namespace tubetwin
