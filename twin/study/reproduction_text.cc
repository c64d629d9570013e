#include <algorithm>
#include <cstdio>

#include "models/base/json.h"
#include "twin/study/reproduction.h"

namespace tubetwin {
namespace {

std::string CellText(const ReproductionCell& cell) {
  char text[96];
  if (const auto* time = std::get_if<MeanTime>(&cell)) {
    std::snprintf(text, sizeof text, "%.2f ± %.2f s [%.2f, %.2f]", time->mean_s, time->sd_s,
                  time->mean95_s.low, time->mean95_s.high);
    return text;
  }
  const auto* rate = std::get_if<Rate>(&cell);
  if (rate == nullptr) return "-";
  const auto [k, n] = rate->counts;
  if (n == 0) return "- (0)";
  const ShareInterval interval = Interval95(*rate);
  std::snprintf(text, sizeof text, "%d/%d = %.0f %% [%.0f, %.0f]", k, n, 100.0 * k / n,
                100.0 * interval.low, 100.0 * interval.high);
  return text;
}

Json CellJson(const ReproductionCell& cell) {
  if (const auto* rate = std::get_if<Rate>(&cell)) return ToJson(*rate);
  const auto* time = std::get_if<MeanTime>(&cell);
  if (time == nullptr) return nullptr;
  return Json{{"n", time->n},
              {"mean", time->mean_s},
              {"sd", time->sd_s},
              {"mean95", Json::array({time->mean95_s.low, time->mean95_s.high})}};
}

Json RowJson(const ReproductionRow& row) {
  Json out{{"set", row.set}, {"what", row.what}, {"tubes_left", nullptr}};
  if (row.tubes_left) out["tubes_left"] = *row.tubes_left;
  out["paper"] = CellJson(row.paper);
  for (std::size_t i = 0; i < row.ours.size(); ++i) {
    out[kReproductionProfiles[i]] = CellJson(row.ours[i]);
  }
  out["apart"] = row.apart;
  return out;
}

std::string NameOf(const ReproductionRow& row) {
  std::string out = "Set " + row.set + ", " + row.what;
  if (row.tubes_left) out += ", " + std::to_string(*row.tubes_left) + " in the bin";
  return out;
}

}  // namespace

Json ToJson(const Reproduction& reproduction) {
  Json out{{"schema", "tubetwin/reproduction/1"},
           {"seed", reproduction.seed},
           {"rounds", reproduction.rounds},
           {"tables", Json::array()}};
  for (const ReproductionTable& table : reproduction.tables) {
    Json rows = Json::array();
    for (const ReproductionRow& row : table.rows) rows.push_back(RowJson(row));
    out["tables"].push_back(
        Json{{"table", table.number}, {"title", table.title}, {"rows", std::move(rows)}});
  }
  return out;
}

std::string ReproductionText(const Reproduction& reproduction) {
  std::string out = "# Tables 3 to 9 of the 2020 paper beside the twin\n\n" +
                    std::to_string(reproduction.rounds) + " rounds of each set and profile, seed " +
                    std::to_string(reproduction.seed) +
                    ". Shares by truth with 95 % intervals, ours by rounds (Wilson's of the "
                    "effective sample size), the paper's and those of bins Wilson's; times as mean "
                    "± standard deviation with Student's 95 % interval of the mean.\n";
  std::string apart;
  for (const ReproductionTable& table : reproduction.tables) {
    const std::string number = std::to_string(table.number);
    out += "\n## Table " + number + ". " + table.title +
           "\n\n| | paper | leao2020 profile | best |\n|---|---|---|---|\n";
    for (const ReproductionRow& row : table.rows) {
      out += "| " + NameOf(row) + " | " + CellText(row.paper);
      for (const ReproductionCell& cell : row.ours) out += " | " + CellText(cell);
      out += " |\n";
      for (std::size_t i = 0; i < row.ours.size(); ++i) {
        const std::string profile = kReproductionProfiles[i];
        if (std::count(row.apart.begin(), row.apart.end(), profile) == 0) continue;
        apart += "- Table " + number + ", " + NameOf(row) + ": " + profile + " " +
                 CellText(row.ours[i]) + ", paper " + CellText(row.paper) + "\n";
      }
    }
  }
  out += "\n## Where intervals do not meet the paper's\n\n" +
         (apart.empty() ? std::string("Nowhere.\n") : apart);
  out +=
      "\n## What was done otherwise\n\n"
      "- The cell is the twin: contacts, hoses and noise are models, the paper's were real.\n"
      "- Piles are dropped at random by the generator; the paper does not say how the tubes came "
      "into the bin.\n"
      "- The overhead scan is ours to place: 0.80 m over the floor; the paper says only that the "
      "corners were out of sight and that from higher up there was too much noise.\n"
      "- The leao2020 profile takes normals from the 100,000 sampled points, not from all; that "
      "is what the paper says brings modelling to about 1 s. Parameters the paper does not give "
      "are named in the configuration; limits of joints are among them (here 5 cm and 70 "
      "degrees).\n"
      "- d_const is 3 cm or three radii, whichever is more: the paper says both, for set A they "
      "differ. The height term of a grasp's cost prefers high points, as the paper's text does; "
      "its formula prefers low ones.\n"
      "- The gripper must also keep off perceived tubes, not only off points, and the arm must "
      "reach; the last centimetre down is guarded; a grasp that failed is tried last until a tube "
      "is placed. The paper has none of these.\n"
      "- Nothing modelled is looked at once more before the round ends, whether the bin is empty "
      "or not.\n"
      "- Roll-outs run in MuJoCo with the tubes alone, not in Gazebo and ODE; the lifted tube is "
      "pulled with limited force, and motions that jam come last.\n"
      "- In best, every motion but upward ones counts as escape.\n"
      "- A hose is a chain of rigid links; its friction and bend are set to meet the paper's rates "
      "of several tubes lifted and of those that +45 degrees separates.\n";
  return out;
}

}  // namespace tubetwin
