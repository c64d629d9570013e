#include "twin/render/perceived_picture.h"

#include <opencv2/imgproc.hpp>

#include "twin/render/film_panels.h"
#include "twin/render/picture.h"
#include "twin/render/stage.h"

namespace tubetwin {
namespace {

constexpr Colour kHidden = {0.12f, 0.12f, 0.14f};
constexpr Colour kUnexplained = {0.95f, 0.10f, 0.80f};
constexpr Colour kUnseen = {0.55f, 0.10f, 0.12f};
constexpr Colour kScanned = {0.20f, 0.55f, 0.80f};
constexpr double kScannedRadius_m = 0.0018;
constexpr double kHiddenRadius_m = 0.0025, kUnexplainedRadius_m = 0.0025, kHatchRadius_m = 0.0008;
constexpr std::size_t kMaxPlaces = 3000;  ///< The scene holds no more; the rest look the same.

/// The tubes as bodies at rest: any shape is drawn as it was perceived.
Pile AsPile(const PerceivedPicture& seen) {
  Pile pile;
  pile.bin = seen.bin;
  for (const PerceivedPicture::Tube& tube : seen.tubes) {
    pile.tubes.push_back({tube.id, tube.centerline_N, tube.radius_m, pile.part.mass_kg, {}});
  }
  return pile;
}

/// A line along the top of every run of hidden nodes.
void AddHidden(const PerceivedPicture::Tube& tube, const RigidTransform& X_BN,
               std::vector<Stroke>& strokes) {
  const Vector3 top_N(0, 0, tube.radius_m);
  Polyline run;
  for (std::size_t i = 0; i <= tube.centerline_N.size(); ++i) {
    if (i < tube.centerline_N.size() && tube.node_visible[i] == 0) {
      run.push_back(tube.centerline_N[i] + top_N);
      continue;
    }
    if (run.size() > 1) strokes.push_back({Transformed(X_BN, run), kHiddenRadius_m, kHidden});
    run.clear();
  }
}

/// Places as dots, evenly thinned to what the scene holds.
void AddPlaces(const Polyline& places_N, const RigidTransform& X_BN, double radius_m,
               const Colour& colour, std::vector<Stroke>& strokes) {
  const std::size_t stride = places_N.size() / kMaxPlaces + 1;
  for (std::size_t i = 0; i < places_N.size(); i += stride) {
    const Vector3 p_B = X_BN * places_N[i];
    strokes.push_back({{p_B, p_B + Vector3(0, 0, 1e-4)}, radius_m, colour});
  }
}

std::vector<Stroke> Strokes(const PerceivedPicture& seen) {
  const RigidTransform& X_BN = seen.bin.X_BN;
  std::vector<Stroke> strokes;
  for (const PerceivedPicture::Tube& tube : seen.tubes) AddHidden(tube, X_BN, strokes);
  for (const Polyline& line_N : seen.unseen_floor_N) {
    strokes.push_back({Transformed(X_BN, line_N), kHatchRadius_m, kUnseen});
  }
  AddPlaces(seen.unexplained_N, X_BN, kUnexplainedRadius_m, kUnexplained, strokes);
  AddPlaces(seen.cloud_N, X_BN, kScannedRadius_m, kScanned, strokes);
  return strokes;
}

cv::Scalar Bgr(const Colour& c) { return {255 * c[2], 255 * c[1], 255 * c[0]}; }

void DrawLegend(cv::Mat& image, const std::string& caption, bool scanned) {
  const auto text = [&image](const std::string& words, const cv::Point& at) {
    cv::putText(image, words, at + cv::Point(1, 1), cv::FONT_HERSHEY_SIMPLEX, 0.55, {20, 20, 20}, 2,
                cv::LINE_AA);
    cv::putText(image, words, at, cv::FONT_HERSHEY_SIMPLEX, 0.55, {245, 245, 245}, 1, cv::LINE_AA);
  };
  struct Entry {
    const char* name;
    Colour colour;
  };
  std::vector<Entry> entries = {{"free", ClassColour(0)},      {"weak", ClassColour(1)},
                                {"strong", ClassColour(2)},    {"hidden", kHidden},
                                {"unexplained", kUnexplained}, {"unseen floor", kUnseen}};
  if (scanned) entries = {{"scanned", kScanned}};
  text(caption, {24, 36});
  int x = 24;
  for (const Entry& entry : entries) {
    const int y = image.rows - 28;
    cv::circle(image, {x + 7, y - 5}, 7, Bgr(entry.colour), cv::FILLED, cv::LINE_AA);
    text(entry.name, {x + 22, y});
    int baseline = 0;
    x += 52 + cv::getTextSize(entry.name, cv::FONT_HERSHEY_SIMPLEX, 0.55, 1, &baseline).width;
  }
}

}  // namespace

void RenderPerceivedPicture(const PerceivedPicture& seen, const std::string& path) {
  std::vector<std::array<double, 3>> colours;
  for (const PerceivedPicture::Tube& tube : seen.tubes) {
    const Colour c = ClassColour(tube.tube_class);
    colours.push_back({c[0], c[1], c[2]});
  }
  const MjModel model = CompileStage(AsPile(seen), colours);
  const MjData data = MakeData(*model);
  SceneRenderer renderer(*model, kPictureWidth, kPictureHeight);
  const View view = PileView(seen.bin);
  Image image = renderer.Draw(*data, view, Strokes(seen));
  cv::Mat pixels(image.height, image.width, CV_8UC3, image.bgr.data());
  for (const PerceivedPicture::Tube& tube : seen.tubes) {
    DrawTag(image, view, Transformed(seen.bin.X_BN, tube.centerline_N), seen.bin.up_B(),
            std::to_string(tube.id));
  }
  DrawLegend(pixels, seen.caption, !seen.cloud_N.empty());
  WritePng(image, path);
}

}  // namespace tubetwin
