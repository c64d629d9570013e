// Scores perception on pile files, one JSON row a pile; perception_table.sh makes the table of it.
//
//   perception_table --setup overhead|cell [--noise K] [--hand-eye] [--threads N] [--dump DIR]
//                    --rows ROWS.jsonl PILE...
//
// overhead: one pinhole view of 1920 x 1200 from 1.1 m, bin and 0.25 m around it, looking down
// within 4 degrees, white depth noise of 0.1 mm along the ray, no shadow, nothing dropped.
// cell: the cell's eight views of 1032 x 772 with the scanner's shadows, drop-out and noise.
// Piles that ROWS holds already are skipped. --dump writes tubes.json beside each pile's name, and
// for the overhead view what tools outside score: cloud (PCD) and labels (a byte a pixel).

#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "models/cell_model.h"
#include "models/physics.h"
#include "perception/perceive.h"
#include "scenes/pile.h"
#include "tests/support/graph_metrics.h"
#include "tests/support/paper_cell.h"
#include "tests/support/paper_scan.h"
#include "twin/render/scan/ray_scene.h"

namespace tubetwin {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string setup = "overhead", rows, dump;
  double noise = 1.0;
  bool hand_eye = false;
  int threads = 2;
  std::vector<std::string> piles;
};

Options ParseOptions(int argc, char** argv) {
  Options out;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    auto value = [&] {
      if (++i >= argc) throw Error(ErrorKind::kUsage, name + ": a value is needed");
      return std::string(argv[i]);
    };
    if (name == "--setup") {
      out.setup = value();
    } else if (name == "--noise") {
      out.noise = std::stod(value());
    } else if (name == "--hand-eye") {
      out.hand_eye = true;
    } else if (name == "--threads") {
      out.threads = std::stoi(value());
    } else if (name == "--dump") {
      out.dump = value();
    } else if (name == "--rows") {
      out.rows = value();
    } else {
      out.piles.push_back(name);
    }
  }
  if (out.rows.empty() || (out.setup != "overhead" && out.setup != "cell")) {
    throw Error(ErrorKind::kUsage, "--rows FILE and --setup overhead or cell are needed");
  }
  return out;
}

/// Bin and tubes in frame N, on a floor that reaches far beyond the bin.
ScanGeometry GeometryOf(const Pile& pile) {
  ScanGeometry out;
  for (std::size_t k = 0; k < pile.tubes.size(); ++k) {
    const Polyline& line = pile.tubes[k].centerline_N;
    for (const AxisPiece& piece : PiecesWithin(line, pile.tubes[k].radius_m)) {
      out.capsules.push_back({piece.from, piece.to, pile.tubes[k].radius_m,
                              kLabelFirstTube + static_cast<std::uint32_t>(k), 0.7f});
    }
  }
  const double x = pile.bin.half_x_m(), y = pile.bin.half_y_m(), h = 0.5 * pile.bin.wall_m();
  const double t = 0.5 * Bin::kWallThickness_m;
  const auto box = [&](const Vector3& centre_N, const Vector3& half_m) {
    out.boxes.push_back({Translation(centre_N), half_m, kLabelCell, 0.5f});
  };
  box({0, 0, -t}, {1.5, 1.5, t});
  for (const double side : {-1.0, 1.0}) {
    box({side * (x + t), 0, h}, {t, y + 2 * t, h});
    box({0, side * (y + t), h}, {x + 2 * t, t, h});
  }
  return out;
}

struct Look {
  std::vector<OrganizedCloud> clouds;
  std::vector<RigidTransform> X_NS_true;
  int stride = 7;
};

Look LookFromAbove(const Pile& pile, RandomStream stream, const Options& options) {
  constexpr double kHeight_m = 1.1, kAround_m = 0.25, kSigma_m = 0.0001;
  Look out;
  const Pinhole camera{1920, 1200,
                       static_cast<float>(1200 * kHeight_m / (pile.bin.size_m[1] + 2 * kAround_m))};
  const Matrix3 tilt = RotX(Radians(stream.Uniform(-4, 4))) * RotY(Radians(stream.Uniform(-4, 4)));
  const Vector3 aim(stream.Uniform(-0.02, 0.02), stream.Uniform(-0.02, 0.02), 0.0);
  const Matrix3 R_NS = tilt * RotX(kPi);
  const RigidTransform X_NS = MakeTransform(R_NS, aim - kHeight_m * R_NS.col(2));
  const RayScene scene(GeometryOf(pile), X_NS, PaperCell().scanner);
  HitImage hits(camera);
  scene.CastRows(camera, 0, camera.height, false, hits);
  OrganizedCloud cloud;
  cloud.width = camera.width;
  cloud.height = camera.height;
  cloud.X_NS = X_NS;
  const std::size_t pixels = static_cast<std::size_t>(camera.width) * camera.height;
  cloud.p_SP.assign(pixels, InvalidPoint());
  cloud.label.assign(pixels, kLabelNone);
  const ScanGeometry geometry = GeometryOf(pile);
  for (std::size_t i = 0; i < pixels; ++i) {
    const int row = static_cast<int>(i / camera.width), column = static_cast<int>(i % camera.width);
    const double noise_m = kSigma_m * options.noise * stream.Normal();
    const std::size_t hit = hits.Index(row, column);
    if (hits.shape[hit] < 0) continue;
    const auto shape = static_cast<std::size_t>(hits.shape[hit]);
    const Eigen::Vector3d ray(camera.x(column), camera.y(row), 1.0);
    cloud.p_SP[i] = ((hits.z_m[hit] + noise_m / ray.norm()) * ray).cast<float>();
    cloud.label[i] = shape < geometry.capsules.size() ? geometry.capsules[shape].label : kLabelCell;
  }
  out.clouds.push_back(std::move(cloud));
  out.X_NS_true.push_back(X_NS);
  return out;
}

Look LookFromCell(const Pile& pile, const RandomStream& stream, const Options& options) {
  Look out;
  ScanSettings settings = PaperScan();
  settings.noise_scale = options.noise;
  settings.labels = true;
  const RoundPhysics physics = options.hand_eye
                                   ? DrawPhysics(PhysicsRanges{}, pile.part, stream.Fork("physics"))
                                   : NominalPhysics(pile.part);
  const ScanGeometry geometry = GeometryOf(pile);
  for (const RigidTransform& X_BS : ScanPosesOf(PaperCell(), pile.bin)) {
    const RigidTransform X_NS = pile.bin.X_BN.inverse() * X_BS;
    out.X_NS_true.push_back(X_NS * physics.X_SbelievedS);
    out.clouds.push_back(CastScan(geometry, out.X_NS_true.back(), settings,
                                  stream.Fork("view", out.clouds.size()),
                                  Parallelism{options.threads}));
    out.clouds.back().X_NS = X_NS;
  }
  out.stride = 17;
  return out;
}

Json Micrometres(const std::vector<double>& errors_m) {
  Json out = Json::array();
  for (const double e : errors_m) out.push_back(std::lround(1e6 * e));
  return out;
}

Json RowOf(const TubeScene& scene, const Pile& pile, const Look& look) {
  std::vector<Polyline> truth;
  for (const PileTube& tube : pile.tubes) truth.push_back(tube.centerline_N);
  const double r = pile.part.radius_m;
  const auto points = TubePointsOf(look.clouds, look.X_NS_true, look.stride);
  const TubeScore score = ScoreTubes(scene, truth, points, r);
  const auto seen = FindSeen(truth, points);
  const CrossingScore crossings = ScoreCrossings(scene, truth, seen, score, r);
  const JointScore joints = ScoreJoints(scene, truth, seen);
  const CenterlineErrors errors = MeasureErrors(scene, truth, seen, score);
  const TubeScene::Timing& t = scene.timing_ms;
  return Json{{"points", points.size()},
              {"micro_recall", score.micro_recall},
              {"tubes", score.true_tubes},
              {"predicted", score.predicted},
              {"found", score.found},
              {"paired", score.paired},
              {"class_right", score.class_right},
              {"covered", score.covered},
              {"covered_called_free", score.covered_called_free},
              {"visible", {crossings.visible, crossings.visible_right, crossings.visible_reversed}},
              {"hidden", {crossings.hidden, crossings.hidden_right, crossings.hidden_reversed}},
              {"unseen_end", {crossings.on_unseen_end, crossings.on_unseen_end_right}},
              {"spurious", crossings.spurious},
              {"joints", {joints.truth, joints.perceived, joints.right}},
              {"seen_um", Micrometres(errors.seen_m)},
              {"hidden_um", Micrometres(errors.hidden_m)},
              {"length_error_mm", 1e3 * score.length_error_median_m},
              {"ms", {t.filter, t.segment, t.fit, t.join, t.crossings, t.total}}};
}

void Dump(const TubeScene& scene, const Look& look, const std::string& base) {
  WriteJsonFile(ToJson(scene), base + ".tubes.json");
  if (look.clouds.size() != 1) return;
  OrganizedCloud cloud = look.clouds[0];
  std::string labels;
  for (const std::uint32_t label : cloud.label) labels.push_back(static_cast<char>(label));
  cloud.label.clear();
  WritePcd(cloud, base + ".pcd");
  WriteFileAtomically(base + ".labels", labels);
}

std::set<std::string> DonePiles(const std::string& rows) {
  std::set<std::string> out;
  std::ifstream in(rows);
  for (std::string line; std::getline(in, line);) {
    const Json row = Json::parse(line, nullptr, false);
    if (!row.is_discarded()) out.insert(row.at("pile"));
  }
  return out;
}

int Run(const Options& options) {
  const std::set<std::string> done = DonePiles(options.rows);
  for (const std::string& path : options.piles) {
    if (done.contains(path)) continue;
    const Pile pile = LoadPile(path);
    const RandomStream stream(pile.seed, pile.tubes.size(), pile.part.name);
    const Look look = options.setup == "overhead"
                          ? LookFromAbove(pile, stream.Fork("above"), options)
                          : LookFromCell(pile, stream.Fork("cell"), options);
    std::vector<OrganizedCloud> views = look.clouds;
    for (OrganizedCloud& view : views) view.label.clear();
    const TubeScene scene = Perceive(views, pile.part, pile.bin, {}, Parallelism{options.threads});
    Json row{{"pile", path},           {"part", pile.part.name}, {"count", pile.tubes.size()},
             {"setup", options.setup}, {"noise", options.noise}, {"hand_eye", options.hand_eye}};
    row.update(RowOf(scene, pile, look));
    std::ofstream(options.rows, std::ios::app) << row.dump() << std::endl;
    if (!options.dump.empty()) {
      MakeFolder(options.dump);
      std::string name = fs::path(path).string();
      for (char& c : name) c = c == '/' ? '_' : c;
      Dump(scene, look, (fs::path(options.dump) / name).string());
    }
  }
  return 0;
}

}  // namespace
}  // namespace tubetwin

int main(int argc, char** argv) {
  try {
    return tubetwin::Run(tubetwin::ParseOptions(argc, argv));
  } catch (const tubetwin::Error& e) {
    std::fprintf(stderr, "perception_table: %s\n", e.what());
    return 65;
  }
}
