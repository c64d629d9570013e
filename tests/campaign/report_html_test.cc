#include "twin/campaign/report_html.h"
#include "hw_bridge/base/json.h"

#include <algorithm>
#include <filesystem>

#include "hw_bridge/base/files.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "twin/campaign/report_chart.h"

namespace tubetwin {
namespace {

Json Summary() {
  return Json::parse(R"({"schema": "tubetwin/summary/1", "tubes_start": 7, "placed": 6,
      "attempts": 9, "first_attempt": {"k": 5, "n": 6, "wilson95": [0.4, 0.9]}, "emptied": false,
      "end_reason": "no_plan", "end_detail": "tube 3 <under> the wall", "outside": 0,
      "dropped": 1, "sim_s": 412.25, "sim_s_per_pick": 68.7})");
}

Json PlacedRow() {
  return Json::parse(R"({"round": 0, "attempt": 1, "tubes_in_bin": 7, "target": 2, "class": "free",
      "motion": {"name": "up", "waypoints_m": []}, "grasp": {}, "used_simulator": false,
      "detection": {"outcome": "one", "force_N": 0.538, "torque_Nm": [0, 0, 0], "at_s": 20.5},
      "resolution": {"used": false, "strategy": null, "outcome": null}, "outcome": "placed",
      "reason": "", "success": true,
      "sim_s": {"scan": 10, "move": 20, "weigh": 5, "settle": 1, "total": 36},
      "truth": {"held": [2], "placed_ids": [2], "outside_ids": []}})");
}

Json BareRow() {
  return Json::parse(R"({"round": 0, "attempt": 1, "tubes_in_bin": 1, "target": null,
      "class": null, "motion": null, "grasp": null, "used_simulator": false, "detection": null,
      "resolution": {"used": true, "strategy": "plus45", "outcome": "several"},
      "outcome": "no_plan", "reason": "<script>alert('x')</script> & \"more\"", "success": null,
      "sim_s": {"scan": 10, "move": 0, "weigh": 0, "settle": 0, "total": 10}, "truth": null})");
}

int CountOf(const std::string& text, const std::string& what) {
  int count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
    ++count;
  }
  return count;
}

}  // namespace

TEST_CASE("the report leads with what was placed, with its interval") {
  const std::string html = ReportHtml(Summary(), {PlacedRow()}, {});
  CHECK_THAT(html, Catch::Contains("<h1>Placed 6 of 7 tubes</h1>"));
  CHECK_THAT(html, Catch::Contains("6 of 7 (86 %, 95 % interval 49 to 97 %)"));
  CHECK_THAT(html, Catch::Contains("5 of 6 (83 %, 95 % interval 44 to 97 %)"));
  CHECK_THAT(html, Catch::Contains("The bin was not emptied."));
  CHECK(html.find("<h1>") < html.find("<h2>"));
}

TEST_CASE("every attempt has its row with what was chosen and why") {
  Json simulated = PlacedRow();
  simulated["used_simulator"] = true;
  simulated["class"] = "strong";
  simulated["motion"]["name"] = "escape";
  const std::string html = ReportHtml(Summary(), {PlacedRow(), simulated, BareRow()}, {});
  CHECK_THAT(html, Catch::Contains("up: nothing lies over it, no simulation needed"));
  CHECK_THAT(html, Catch::Contains("escape: least displacement of the other tubes"));
  CHECK_THAT(html, Catch::Contains("one, 0.54 N"));
  CHECK_THAT(html, Catch::Contains("plus45: several"));
}

TEST_CASE("every text is escaped and nothing can run or be fetched") {
  Json summary = Summary();
  summary["end_reason"] = "</p><img src=x onerror=alert(1)>";
  Json row = PlacedRow();
  row["motion"]["name"] = "<b>";
  row["class"] = "\"'><i>";
  const std::string html = ReportHtml(summary, {row, BareRow()}, {true, true});
  CHECK_THAT(html, !Catch::Contains("<script") && !Catch::Contains("<img src=x") &&
                       !Catch::Contains("<b>") && !Catch::Contains("<i>") &&
                       !Catch::Contains("http:") && !Catch::Contains("https:"));
  CHECK_THAT(html, Catch::Contains("&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt; &amp; "
                                   "&quot;more&quot;"));
  CHECK_THAT(html, Catch::Contains("default-src 'none'; style-src 'unsafe-inline'"));
}

TEST_CASE("tags are balanced") {
  const std::string html = ReportHtml(Summary(), {PlacedRow(), BareRow()}, {true, true});
  for (const char* tag : {"table", "tr", "td", "th", "div", "figure", "svg", "p", "h2", "body",
                          "video", "figcaption", "title", "text"}) {
    const std::string name(tag);
    INFO(name);
    CHECK(CountOf(html, "<" + name + ">") + CountOf(html, "<" + name + " ") ==
          CountOf(html, "</" + name + ">"));
  }
}

TEST_CASE("the time table adds up") {
  const std::string html = ReportHtml(Summary(), {PlacedRow(), BareRow()}, {});
  CHECK_THAT(html, Catch::Contains("<tr><th>scan</th><td class=\"n\">10.00</td>"
                                   "<td class=\"n\">20.0</td><td class=\"n\">43 %</td></tr>"));
  CHECK_THAT(html, Catch::Contains("<tr><th>total</th><td class=\"n\">23.00</td>"
                                   "<td class=\"n\">46.0</td><td class=\"n\">100 %</td></tr>"));
}

TEST_CASE("belief is set against truth, unknown where a cell has none") {
  Json wrong = PlacedRow();
  wrong["success"] = false;
  const std::string html = ReportHtml(Summary(), {PlacedRow(), wrong, BareRow()}, {});
  CHECK_THAT(html, Catch::Contains("<tr><th>placed</th><td class=\"n\">1</td><td class=\"n\">1</td>"
                                   "<td class=\"n\">0</td></tr>"));
  CHECK_THAT(html, Catch::Contains("<tr><th>no_plan</th><td class=\"n\">0</td><td class=\"n\">0"
                                   "</td><td class=\"n\">1</td></tr>"));
}

TEST_CASE("film and picture are shown only when they lie beside the report") {
  const TemporaryFolder folder;
  WriteReport(Summary(), {PlacedRow()}, folder.path());
  CHECK_THAT(ReadFile(folder / "report.html"), !Catch::Contains("picture.png"));
  WriteFileAtomically(folder / "picture.png", "x");
  WriteReport(Summary(), {PlacedRow()}, folder.path());
  CHECK_THAT(ReadFile(folder / "report.html"),
             Catch::Contains("<img src=\"picture.png\"") && !Catch::Contains("video.mp4"));
  WriteFileAtomically(folder / "video.mp4", "x");
  WriteReport(Summary(), {PlacedRow()}, folder.path());
  CHECK_THAT(ReadFile(folder / "report.html"),
             Catch::Contains("poster=\"picture.png\" src=\"video.mp4\""));
}

TEST_CASE("a round without attempts or with an empty summary still gives a page") {
  CHECK_THAT(ReportHtml(Json::object(), {}, {}), Catch::Contains("There was no attempt."));
  CHECK_THAT(ReportHtml(Json::object(), {Json::object()}, {}), Catch::EndsWith("</html>\n"));
}

TEST_CASE("the bars of the chart stand on each other and stay inside the picture") {
  const std::string svg = TimeChartSvg({{10, 20, 5, 1}, {10, 0, 0, 0}, {0, 0, 0, 0}});
  CHECK(CountOf(svg, "<rect") == 12);
  // 36 s is the longest bar, the axis ends at 40 s: 214 px high, 226 px the base line.
  CHECK_THAT(svg, Catch::Contains("class=\"part0\" x=\"158.3\" y=\"172.5\" width=\"60.0\" "
                                  "height=\"53.5\""));
  CHECK_THAT(svg, Catch::Contains("class=\"part1\" x=\"158.3\" y=\"65.5\" width=\"60.0\" "
                                  "height=\"107.0\""));
  CHECK(TimeChartSvg({}).empty());
  CHECK(TimeChartSvg({{0, 0, 0, 0}}).empty());
}

}  // namespace tubetwin
