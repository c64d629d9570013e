#include "twin/render/picture.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "models/base/error.h"
#include "models/base/files.h"
#include "twin/render/pile_picture.h"
#include "twin/render/stage.h"

namespace tubetwin {
namespace {

void DrawCircledText(cv::Mat& image, const Eigen::Vector2d& at, const std::string& text) {
  constexpr double kScale = 0.5;
  int baseline = 0;
  const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kScale, 1, &baseline);
  const cv::Point centre(static_cast<int>(std::lround(at.x())),
                         static_cast<int>(std::lround(at.y())));
  const int radius = std::max(size.width, size.height) / 2 + 5;
  cv::circle(image, centre, radius, {250, 250, 250}, cv::FILLED, cv::LINE_AA);
  cv::circle(image, centre, radius, {60, 50, 45}, 1, cv::LINE_AA);
  cv::putText(image, text, centre + cv::Point(-size.width / 2, size.height / 2),
              cv::FONT_HERSHEY_SIMPLEX, kScale, {40, 34, 30}, 1, cv::LINE_AA);
}

/// Highest node of a tube: what is surely seen.
Vector3 Highest(const Polyline& line, const Vector3& up) {
  Vector3 best = line.front();
  for (const Vector3& p : line) {
    if (p.dot(up) > best.dot(up)) best = p;
  }
  return best;
}

}  // namespace

void DrawTag(Image& image, const View& view, const Polyline& line_B, const Vector3& up_B,
             const std::string& text) {
  cv::Mat pixels(image.height, image.width, CV_8UC3, image.bgr.data());
  const auto at = Project(view, image.width, image.height, Highest(line_B, up_B));
  if (at) DrawCircledText(pixels, *at, text);
}

View PileView(const Bin& bin) {
  const double size = std::max(bin.size_m[0], 1.3 * bin.size_m[1]);
  View view;
  view.target_B = bin.X_BN * Vector3(0, -0.01 * size, 0.3 * bin.wall_m());
  // From the side that the short axis comes from, 55 degrees over the horizon.
  view.eye_B = bin.X_BN * Vector3(0.0, -0.78 * size, 1.12 * size);
  return view;
}

View CellView() {
  View view;
  view.eye_B = {2.13, -1.83, 1.51};
  view.target_B = {0.27, -0.22, 0.36};
  return view;
}

void WritePng(const Image& image, const std::string& path) {
  const cv::Mat pixels(image.height, image.width, CV_8UC3,
                       const_cast<std::uint8_t*>(image.bgr.data()));
  std::vector<std::uint8_t> encoded;
  if (!cv::imencode(".png", pixels, encoded)) {
    throw Error(ErrorKind::kInternal, path + ": the picture cannot be encoded as PNG");
  }
  WriteFileAtomically(path, {reinterpret_cast<const char*>(encoded.data()), encoded.size()});
}

void RenderPilePicture(const Pile& pile, const std::string& path) {
  std::vector<std::array<double, 3>> colours;
  for (std::size_t i = 0; i < pile.tubes.size(); ++i) {
    colours.push_back(PileColour(static_cast<int>(i)));
  }
  const MjModel model = CompileStage(pile, colours);
  const MjData data = MakeData(*model);
  SceneRenderer renderer(*model, kPictureWidth, kPictureHeight);
  const View view = PileView(pile.bin);
  Image image = renderer.Draw(*data, view, {});
  for (const PileTube& tube : pile.tubes) {
    DrawTag(image, view, Transformed(pile.bin.X_BN, tube.centerline_N), pile.bin.up_B(),
            std::to_string(tube.id));
  }
  WritePng(image, path);
}

}  // namespace tubetwin
