#include "twin/report/parts.h"

#include <algorithm>

#include "models/base/json.h"
#include "twin/report/chart.h"
#include "twin/report/text.h"

namespace tubetwin {
namespace {

std::string Check(const std::string& id, const std::string& label, bool checked) {
  return "<label><input type=\"checkbox\" id=\"" + id + "\"" + (checked ? " checked" : "") + "> " +
         label + "</label>";
}

std::string Picture(const ShownAttempt& attempt, std::size_t index) {
  if (attempt.picture.empty()) return "";
  return "<canvas class=\"picture\" data-picture=\"" + std::to_string(index) +
         "\" role=\"img\" aria-label=\"The cell in " + Escaped(attempt.label) + "\"></canvas>";
}

std::string GalleryCard(const ShownAttempt& attempt, std::size_t index, int scene) {
  std::string out = "<article class=\"shot\">" + Picture(attempt, index) + attempt.plan_svg +
                    "<div class=\"shot-text\"><h3>" + Escaped(FailureName(attempt.failure)) +
                    "</h3><p>" + Escaped(attempt.label) +
                    "; believed: " + Escaped(FailureName(attempt.believed)) +
                    (attempt.reason.empty() ? "" : " (" + Escaped(attempt.reason) + ")") + "</p>" +
                    attempt.trace_svg + "<p class=\"links\">";
  if (scene >= 0) {
    out += "<a href=\"#view\" data-scene=\"" + std::to_string(scene) + "\">3-D view</a> ";
  }
  if (!attempt.film.empty()) {
    out += "<a href=\"" + LinkTo(attempt.film) + "\">film</a> ";
  }
  return out + "</p><pre class=\"command\">" + Escaped(RepeatCommand(attempt.folder)) +
         "</pre></div></article>\n";
}

}  // namespace

std::string RateMark(const Rate& rate) {
  const auto [k, n] = rate.counts;
  if (n == 0) return "";
  const ShareInterval interval = Interval95(rate);
  return IntervalMarkSvg(static_cast<double>(k) / n, interval.low, interval.high);
}

std::string RateCard(const std::string& label, const Rate& rate, const Pointer& at) {
  return "<div class=\"card\"><h3>" + label + "</h3><p class=\"big\">" + PercentHtml(rate, at) +
         "</p>" + RateMark(rate) + "<p class=\"quiet\">" + RateDetailHtml(rate, at) +
         "</p></div>\n";
}

std::string FactList(const std::vector<std::pair<std::string, std::string>>& facts) {
  std::string out = "<dl class=\"facts\">";
  for (const auto& [name, value] : facts) {
    out += "<div><dt>" + name + "</dt><dd>" + value + "</dd></div>";
  }
  return out + "</dl>\n";
}

std::string Section(const std::string& id, const std::string& heading, const std::string& content) {
  if (content.empty()) return "";
  return "<section id=\"" + id + "\">\n<h2>" + heading + "</h2>\n" + content + "</section>\n";
}

std::string Figure(const std::string& chart, const std::string& caption) {
  if (chart.empty()) return "";
  return "<figure><div class=\"wide\">" + chart + "</div><figcaption>" + caption +
         "</figcaption></figure>\n";
}

std::string Legend(const std::vector<std::pair<std::string, std::string>>& classes_and_names) {
  std::string out = "<span class=\"legend\">";
  for (const auto& [css_class, name] : classes_and_names) {
    out += "<span class=\"entry\"><svg class=\"swatch\" viewBox=\"0 0 8 8\"><rect class=\"" +
           css_class + "\" width=\"8\" height=\"8\"/></svg>" + Escaped(name) + "</span> ";
  }
  return out + "</span>";
}

std::string FailureName(const std::string& failure) {
  std::string out = failure;
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

std::string ViewerHtml(const std::vector<ShownAttempt>& attempts) {
  std::string options;
  int scene = 0;
  for (const ShownAttempt& attempt : attempts) {
    if (attempt.scene.is_null()) continue;
    options +=
        "<option value=\"" + std::to_string(scene++) + "\">" + Escaped(attempt.label) + ": " +
        (attempt.failure.empty() ? "success" : Escaped(FailureName(attempt.failure))) + "</option>";
  }
  if (options.empty()) return "";
  return "<div class=\"viewer\"><div class=\"bar\"><label>Attempt <select id=\"attempt\">" +
         options + "</select></label><span class=\"checks\">" + Check("show-arm", "arm", true) +
         Check("show-tubes", "tubes", true) + Check("show-seen", "perceived", true) +
         Check("show-cloud", "cloud", true) + Check("show-path", "path", true) +
         "</span></div><div id=\"stage\" tabindex=\"0\" role=\"img\" aria-label=\"The attempt in "
         "3-D\"><p id=\"stage-note\" class=\"quiet\">The 3-D view needs scripts and "
         "WebGL.</p></div>"
         "<div class=\"bar\"><button id=\"play\" type=\"button\">Play</button>"
         "<input id=\"time\" type=\"range\" min=\"0\" max=\"1\" step=\"0.01\" value=\"0\" "
         "aria-label=\"Time\"><span id=\"clock\"></span></div><p id=\"caption\" class=\"quiet\">"
         "</p><div class=\"force-box\"><canvas id=\"force-chart\" role=\"img\" "
         "aria-label=\"Load at the wrist over time\"></canvas></div><p class=\"quiet\">Drag to "
         "turn, wheel or pinch to come closer, right button to move; arrow keys step through time. "
         "Perceived centerlines: " +
         Legend({{"class0", "free"}, {"class1", "weak"}, {"class2", "strong"}}) +
         "The chosen one is thick; tubes lie as they truly did.</p></div>\n";
}

std::string GalleryHtml(const std::vector<ShownAttempt>& attempts) {
  std::string out;
  int scene = 0;
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    const int own = attempts[i].scene.is_null() ? -1 : scene++;
    if (!attempts[i].failure.empty()) out += GalleryCard(attempts[i], i, own);
  }
  if (out.empty()) return "";
  return "<div class=\"gallery\">\n" + out + "</div>\n";
}

std::string TracesHtml(const std::vector<ShownAttempt>& attempts) {
  std::vector<const ShownAttempt*> ordered;
  for (const ShownAttempt& attempt : attempts) {
    if (!attempt.trace_svg.empty()) ordered.push_back(&attempt);
  }
  const bool one_round = std::all_of(ordered.begin(), ordered.end(), [&](const auto* attempt) {
    return attempt->folder == ordered.front()->folder;
  });
  if (one_round) {  // Then in the order of time, else failures first.
    std::stable_sort(ordered.begin(), ordered.end(),
                     [](const auto* a, const auto* b) { return a->row < b->row; });
  }
  std::string out;
  for (const ShownAttempt* attempt : ordered) {
    out += "<figure class=\"small\"><figcaption>" + Escaped(attempt->label) + ": <b class=\"" +
           (attempt->failure.empty() ? "good\">placed"
                                     : "bad\">" + Escaped(FailureName(attempt->failure))) +
           "</b></figcaption>" + attempt->trace_svg + "</figure>\n";
  }
  if (out.empty()) return "";
  return "<p class=\"quiet\">Newtons below the wrist sensor over the seconds of the attempt, tared "
         "before the grasp; weighing is shaded, the dashed line is the decision how many tubes "
         "hang.</p>\n<div class=\"traces\">" +
         out + "</div>\n";
}

std::string HeaderHtml(const std::string& eyebrow, const std::string& title,
                       const std::string& lead) {
  return "<header><button id=\"theme\" type=\"button\" hidden>Light / dark</button><p "
         "class=\"eyebrow\">" +
         eyebrow + "</p>\n<h1>" + title + "</h1>\n<p class=\"lead\">" + lead + "</p></header>\n";
}

}  // namespace tubetwin
