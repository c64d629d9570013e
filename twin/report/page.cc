#include "twin/report/page.h"

#include "models/base/json.h"
#include "twin/report/assets.h"
#include "twin/report/text.h"

namespace tubetwin {
namespace {

std::string Script(std::string_view text) {
  return "<script>\n" + std::string(text) + "\n</script>\n";
}

}  // namespace

std::string ReportPage(const std::string& title, const std::string& body, const Json& data) {
  std::string out =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "script-src 'unsafe-inline'; style-src 'unsafe-inline'; base-uri 'none'; "
      "form-action 'none'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>" +
      Escaped(title) + "</title>\n<style>\n" + std::string(report_assets::kStyle) +
      "</style>\n</head>\n<body>\n" + body + "<script type=\"application/json\" id=\"data\">" +
      ScriptJson(data) + "</script>\n<!--\n" + std::string(report_assets::kLicences) + "-->\n";
  const bool has_scene = !data["cells"].empty();
  if (has_scene || data.contains("times")) out += Script(report_assets::kChartJs);
  if (has_scene) {
    out += Script(report_assets::kThreeJs) + Script(report_assets::kOrbitControlsJs) +
           Script(report_assets::kViewerScript);
  }
  return out + Script(report_assets::kPageScript) + "</body>\n</html>\n";
}

Json AttemptData(const std::vector<ShownAttempt>& attempts) {
  Json out;
  out["attempts"] = Json::array();
  out["cells"] = Json::array();
  out["pictures"] = Json::array();
  std::vector<std::string> known;
  for (const ShownAttempt& attempt : attempts) {
    out["pictures"].push_back(attempt.picture);
    if (attempt.scene.is_null()) continue;
    Json scene = attempt.scene;
    const std::string cell = scene["cell"].dump();
    std::size_t at = 0;
    while (at < known.size() && known[at] != cell) ++at;
    if (at == known.size()) {
      known.push_back(cell);
      out["cells"].push_back(scene["cell"]);
    }
    scene["cell"] = at;
    out["attempts"].push_back(
        Json{{"label", attempt.label}, {"failure", attempt.failure}, {"scene", std::move(scene)}});
  }
  return out;
}

}  // namespace tubetwin
