#include "tests/support/tube_metrics.h"

#include <algorithm>
#include <numeric>

#include "models/base/error.h"
#include "models/base/random.h"
#include "tests/support/catch.h"
#include "tests/support/tube_scenes.h"

namespace tubetwin {
namespace {

double Gain(const std::vector<std::vector<double>>& gain, const std::vector<int>& column) {
  double sum = 0;
  for (std::size_t i = 0; i < gain.size(); ++i) {
    if (column[i] >= 0) sum += gain[i][static_cast<std::size_t>(column[i])];
  }
  return sum;
}

TEST_CASE("The assignment is as good as the best of all permutations", "[unit]") {
  RandomStream stream(1, 0, "assignment");
  for (int trial = 0; trial < 200; ++trial) {
    const std::size_t rows = 1 + stream.Index(5), columns = 1 + stream.Index(5);
    std::vector<std::vector<double>> gain(rows, std::vector<double>(columns));
    for (auto& row : gain) {
      for (double& g : row) g = stream.Uniform(0, 10);
    }
    std::vector<int> order(std::max(rows, columns));
    std::iota(order.begin(), order.end(), 0);
    double best = 0;
    do {
      std::vector<int> column(rows);
      for (std::size_t i = 0; i < rows; ++i) {
        column[i] = order[i] < static_cast<int>(columns) ? order[i] : -1;
      }
      best = std::max(best, Gain(gain, column));
    } while (std::next_permutation(order.begin(), order.end()));
    const std::vector<int> chosen = AssignOneToOne(gain);
    std::vector<int> used = chosen;
    std::sort(used.begin(), used.end());
    used.erase(used.begin(), std::upper_bound(used.begin(), used.end(), -1));
    CHECK(std::adjacent_find(used.begin(), used.end()) == used.end());
    CHECK(Gain(gain, chosen) == Approx(best).epsilon(1e-12));
  }
}

TubeScene SeenScene(const std::vector<Polyline>& lines_N) {
  TubeScene scene;
  for (const Polyline& line : lines_N) {
    PerceivedTube tube;
    tube.id = static_cast<int>(scene.tubes.size());
    tube.centerline_N = line;
    tube.node_visible.assign(line.size(), 1);
    scene.tubes.push_back(tube);
  }
  AssignClasses(scene, kRadius);
  return scene;
}

/// Points on the upper side of every line, `per_m` per metre.
std::vector<TubePoint> TopOf(const std::vector<Polyline>& lines_N) {
  std::vector<TubePoint> out;
  for (std::size_t t = 0; t < lines_N.size(); ++t) {
    for (const Vector3& p : Resample(lines_N[t], 0.001)) {
      out.push_back({p + Vector3(0, 0, kRadius), static_cast<int>(t)});
    }
  }
  return out;
}

const std::vector<Polyline> kTruth = {{{-0.2, 0, 0.0125}, {0.2, 0, 0.0125}},
                                      {{0, -0.2, 0.0375}, {0, 0.2, 0.0375}}};

TEST_CASE("The true scene scores full marks in any order", "[unit]") {
  const TubeScore score =
      ScoreTubes(SeenScene({kTruth[1], kTruth[0]}), kTruth, TopOf(kTruth), kRadius);
  // At the crossing the lower tube's top is as near to the upper axis: a point may go either way.
  CHECK(score.micro_recall > 0.995);
  CHECK(score.found == 2);
  CHECK(score.pair_of_true == std::vector<int>{1, 0});
  CHECK(score.centerline_p95_m < 1e-12);
  CHECK(score.class_right == 2);
  CHECK(score.covered_called_free == 0);
}

TEST_CASE("A split tube costs its smaller part and is not found", "[unit]") {
  const Polyline left = {{-0.2, 0, 0.0125}, {-0.05, 0, 0.0125}};
  const Polyline right = {{-0.05, 0, 0.0125}, {0.2, 0, 0.0125}};
  const TubeScore score =
      ScoreTubes(SeenScene({left, right, kTruth[1]}), kTruth, TopOf(kTruth), kRadius);
  // 150 of the first tube's 400 mm are lost, of 800 in all.
  CHECK(score.micro_recall == Approx(1.0 - 0.15 / 0.8).margin(0.005));
  CHECK(score.found == 1);
  CHECK(score.predicted == 3);
}

TEST_CASE("A missing upper tube makes the lower one called free", "[unit]") {
  const TubeScore score = ScoreTubes(SeenScene({kTruth[0]}), kTruth, TopOf(kTruth), kRadius);
  CHECK(score.covered_called_free == 1);
  CHECK(score.found == 1);
  CHECK(score.pair_of_true[1] == -1);
}

TEST_CASE("Scoring without labels is refused", "[unit]") {
  OrganizedCloud cloud;
  cloud.width = cloud.height = 1;
  cloud.p_SP.assign(1, InvalidPoint());
  CHECK_THROWS_WITH(TubePointsOf({cloud}, {RigidTransform::Identity()}, 1),
                    "scoring: cloud 0 has no labels");
}

}  // namespace
}  // namespace tubetwin
