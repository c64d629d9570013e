#include <cstdio>

#include "models/base/json.h"
#include "twin/study/reproduction.h"

namespace tubetwin {
namespace {

std::string CellText(const Json& cell) {
  char text[96];
  if (cell.is_null()) return "-";
  const int n = cell["n"];
  if (cell.contains("mean")) {
    std::snprintf(text, sizeof text, "%.2f ± %.2f s [%.2f, %.2f]", cell["mean"].get<double>(),
                  cell["sd"].get<double>(), cell["mean95"][0].get<double>(),
                  cell["mean95"][1].get<double>());
    return text;
  }
  if (n == 0) return "- (0)";
  const int k = cell["k"];
  std::snprintf(text, sizeof text, "%d/%d = %.0f %% [%.0f, %.0f]", k, n, 100.0 * k / n,
                100.0 * cell["wilson95"][0].get<double>(),
                100.0 * cell["wilson95"][1].get<double>());
  return text;
}

std::string NameOf(const Json& row) {
  std::string out = "Set " + row["set"].get<std::string>() + ", " + row["what"].get<std::string>();
  if (row["tubes_left"].is_number()) out += ", " + row["tubes_left"].dump() + " in the bin";
  return out;
}

}  // namespace

std::string ReproductionText(const Json& tables) {
  std::string out = "# Tables 3 to 9 of the 2020 paper beside the twin\n\n" +
                    tables["rounds"].dump() + " rounds of each set and profile, seed " +
                    tables["seed"].dump() +
                    ". Shares by truth with Wilson's 95 % interval, times as mean ± standard "
                    "deviation with Student's 95 % interval of the mean.\n";
  std::string apart;
  for (const Json& table : tables["tables"]) {
    out += "\n## Table " + table["table"].dump() + ". " + table["title"].get<std::string>() +
           "\n\n| | paper | leao2020 profile | best |\n|---|---|---|---|\n";
    for (const Json& row : table["rows"]) {
      out += "| " + NameOf(row) + " | " + CellText(row["paper"]) + " | " +
             CellText(row["leao2020"]) + " | " + CellText(row["best"]) + " |\n";
      for (const Json& profile : row["apart"]) {
        const auto name = profile.get<std::string>();
        apart += "- Table " + table["table"].dump() + ", " + NameOf(row) + ": " + name + " " +
                 CellText(row[name]) + ", paper " + CellText(row["paper"]) + "\n";
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
