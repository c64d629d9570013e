#include "tests/support/tube_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/base/error.h"

namespace tubetwin {
namespace {

constexpr double kReachRadii = 1.6;
constexpr double kFoundRecall = 0.8;
constexpr double kFoundPrecision = 0.9;
constexpr double kDense_m = 0.001;

double Quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0.0;
  const auto k = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[static_cast<std::size_t>(k)];
}

/// Points shared by each true tube (row) and each perceived one (column).
std::vector<std::vector<double>> Overlap(const TubeScene& scene, std::size_t true_tubes,
                                         const std::vector<TubePoint>& points, double reach_m) {
  std::vector<std::vector<double>> shared(true_tubes, std::vector<double>(scene.tubes.size(), 0.0));
  for (const TubePoint& point : points) {
    double nearest = reach_m;
    int owner = -1;
    for (std::size_t k = 0; k < scene.tubes.size(); ++k) {
      const double d = Closest(scene.tubes[k].centerline_N, point.p_N).distance_m;
      if (d >= nearest) continue;
      nearest = d;
      owner = static_cast<int>(k);
    }
    if (owner >= 0) {
      shared[static_cast<std::size_t>(point.tube)][static_cast<std::size_t>(owner)] += 1.0;
    }
  }
  return shared;
}

std::vector<int> TimesUnder(const std::vector<Polyline>& lines_N, double radius_m) {
  std::vector<int> times(lines_N.size(), 0);
  for (const Crossing& c : FindCrossings(lines_N, radius_m)) {
    ++times[static_cast<std::size_t>(c.under)];
  }
  return times;
}

void ScorePairs(const TubeScene& scene, const std::vector<Polyline>& true_lines_N,
                const std::vector<double>& visible, const std::vector<std::vector<double>>& shared,
                double radius_m, TubeScore& score) {
  const std::vector<int> under = TimesUnder(true_lines_N, radius_m);
  std::vector<double> errors, lengths;
  for (std::size_t t = 0; t < true_lines_N.size(); ++t) {
    const int pair = score.pair_of_true[t];
    if (pair < 0) continue;
    const auto p = static_cast<std::size_t>(pair);
    if (shared[t][p] < 0.5 * std::max(1.0, visible[t])) continue;
    const PerceivedTube& tube = scene.tubes[p];
    ++score.paired;
    for (const Vector3& q : Resample(tube.centerline_N, kDense_m)) {
      errors.push_back(Closest(true_lines_N[t], q).distance_m);
    }
    lengths.push_back(Length(tube.centerline_N) - Length(true_lines_N[t]));
    const TubeClass truth = under[t] == 0   ? TubeClass::kFree
                            : under[t] == 1 ? TubeClass::kWeak
                                            : TubeClass::kStrong;
    score.class_right += truth == tube.tube_class;
    score.covered += truth != TubeClass::kFree;
    score.covered_called_free += truth != TubeClass::kFree && tube.tube_class == TubeClass::kFree;
  }
  score.centerline_median_m = Quantile(errors, 0.5);
  score.centerline_p95_m = Quantile(errors, 0.95);
  score.length_error_median_m = Quantile(lengths, 0.5);
}

}  // namespace

std::vector<TubePoint> TubePointsOf(const std::vector<OrganizedCloud>& clouds,
                                    const std::vector<RigidTransform>& X_NS_true, int stride) {
  TT_CHECK(stride > 0 && clouds.size() == X_NS_true.size());
  std::vector<TubePoint> out;
  for (std::size_t c = 0; c < clouds.size(); ++c) {
    if (clouds[c].label.size() != clouds[c].size()) {
      throw Error(ErrorKind::kBadData, "scoring: cloud " + std::to_string(c) + " has no labels");
    }
    for (std::size_t i = 0; i < clouds[c].size(); i += static_cast<std::size_t>(stride)) {
      if (clouds[c].label[i] < kLabelFirstTube || !IsValid(clouds[c].p_SP[i])) continue;
      out.push_back({X_NS_true[c] * clouds[c].p_SP[i].cast<double>(),
                     static_cast<int>(clouds[c].label[i] - kLabelFirstTube)});
    }
  }
  return out;
}

TubeScore ScoreTubes(const TubeScene& scene, const std::vector<Polyline>& true_lines_N,
                     const std::vector<TubePoint>& points, double radius_m) {
  TubeScore score;
  score.true_tubes = static_cast<int>(true_lines_N.size());
  score.predicted = static_cast<int>(scene.tubes.size());
  score.pair_of_true.assign(true_lines_N.size(), -1);
  score.found_true.assign(true_lines_N.size(), 0);
  std::vector<double> visible(true_lines_N.size(), 0.0);
  for (const TubePoint& point : points) visible.at(static_cast<std::size_t>(point.tube)) += 1.0;
  const auto shared = Overlap(scene, true_lines_N.size(), points, kReachRadii * radius_m);
  std::vector<double> claimed(scene.tubes.size(), 0.0);
  for (const auto& row : shared) {
    for (std::size_t k = 0; k < row.size(); ++k) claimed[k] += row[k];
  }
  score.pair_of_true = AssignOneToOne(shared);
  double hits = 0.0;
  for (std::size_t t = 0; t < shared.size(); ++t) {
    if (score.pair_of_true[t] < 0) continue;
    const auto p = static_cast<std::size_t>(score.pair_of_true[t]);
    hits += shared[t][p];
    score.found_true[t] = visible[t] > 0 && shared[t][p] >= kFoundRecall * visible[t] &&
                          shared[t][p] >= kFoundPrecision * claimed[p];
    score.found += score.found_true[t];
  }
  if (!points.empty()) score.micro_recall = hits / static_cast<double>(points.size());
  ScorePairs(scene, true_lines_N, visible, shared, radius_m, score);
  return score;
}

std::vector<int> AssignOneToOne(const std::vector<std::vector<double>>& gain) {
  const std::size_t rows = gain.size();
  const std::size_t columns = rows > 0 ? gain[0].size() : 0;
  const std::size_t n = std::max(rows, columns);
  std::vector<int> out(rows, -1);
  if (columns == 0) return out;
  auto cost = [&](std::size_t i, std::size_t j) {
    return i <= rows && j <= columns ? -gain[i - 1][j - 1] : 0.0;
  };
  // Rows enter one by one; potentials keep reduced costs at or above zero (indices from 1).
  std::vector<double> u(n + 1, 0.0), v(n + 1, 0.0);
  std::vector<std::size_t> row_of(n + 1, 0), way(n + 1, 0);
  for (std::size_t i = 1; i <= n; ++i) {
    row_of[0] = i;
    std::size_t j0 = 0;
    std::vector<double> least(n + 1, std::numeric_limits<double>::infinity());
    std::vector<char> used(n + 1, 0);
    do {
      used[j0] = 1;
      const std::size_t i0 = row_of[j0];
      double delta = std::numeric_limits<double>::infinity();
      std::size_t j1 = 0;
      for (std::size_t j = 1; j <= n; ++j) {
        if (used[j]) continue;
        const double reduced = cost(i0, j) - u[i0] - v[j];
        if (reduced < least[j]) {
          least[j] = reduced;
          way[j] = j0;
        }
        if (least[j] < delta) {
          delta = least[j];
          j1 = j;
        }
      }
      for (std::size_t j = 0; j <= n; ++j) {
        if (used[j]) {
          u[row_of[j]] += delta;
          v[j] -= delta;
        } else {
          least[j] -= delta;
        }
      }
      j0 = j1;
    } while (row_of[j0] != 0);
    do {
      const std::size_t j1 = way[j0];
      row_of[j0] = row_of[j1];
      j0 = j1;
    } while (j0 != 0);
  }
  for (std::size_t j = 1; j <= columns; ++j) {
    if (row_of[j] >= 1 && row_of[j] <= rows) out[row_of[j] - 1] = static_cast<int>(j - 1);
  }
  return out;
}

}  // namespace tubetwin
