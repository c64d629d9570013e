#include "twin/report/round_page.h"

#include <algorithm>
#include <filesystem>

#include "models/base/error.h"
#include "models/base/files.h"
#include "models/base/json.h"
#include "tests/report/report_fixture.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "twin/report/chart.h"
#include "twin/report/text.h"
#include "twin/round/result_files.h"

namespace tubetwin {
namespace {

using Catch::Contains;

Json Summary() {
  return Json::parse(R"({"schema": "tubetwin/summary/1", "tubes_start": 7, "placed": 6,
      "attempts": 9, "success": {"k": 6, "n": 9, "wilson95": [0.3542, 0.8794]},
      "first_attempt": {"k": 5, "n": 6, "wilson95": [0.4365, 0.9699]}, "emptied": false,
      "end_reason": "no_plan", "end_detail": "tube 3 <under> the wall", "outside": 0,
      "dropped": 1, "sim_s": 412.25, "sim_s_per_pick": 68.7})");
}

Json PlacedRow() {
  return Json::parse(R"({"round": 0, "attempt": 1, "tubes_in_bin": 7, "target": 2, "class": "free",
      "motion": {"name": "up", "waypoints_m": []}, "grasp": {}, "used_simulator": false,
      "detection": {"outcome": "one", "force_N": 0.538, "torque_Nm": [0, 0, 0], "at_s": 1.5},
      "resolution": {"used": false, "strategy": null, "outcome": null}, "outcome": "placed",
      "reason": "", "success": true,
      "sim_s": {"scan": 10, "move": 20, "weigh": 5, "settle": 1, "total": 36},
      "truth": {"held": 1, "placed_ids": [2], "outside_ids": []}})");
}

/// Of a cell without truth.
Json BareRow() {
  return Json::parse(R"({"round": 0, "attempt": 1, "tubes_in_bin": 1, "target": null,
      "class": null, "motion": null, "grasp": null, "used_simulator": false, "detection": null,
      "resolution": {"used": true, "strategy": "plus45", "outcome": "several"},
      "outcome": "no_plan", "reason": "<script>alert('x')</script> & \"more\"", "success": null,
      "sim_s": {"scan": 10, "move": 0, "weigh": 0, "settle": 0, "total": 10}, "truth": null})");
}

RoundReportInput Input(std::vector<Json> rows) {
  RoundReportInput input;
  input.summary = Summary();
  input.rows = std::move(rows);
  return input;
}

}  // namespace

TEST_CASE("the page leads with what was placed, rates with the intervals of summary.json") {
  const std::string html = RoundReportHtml(Input({PlacedRow()}));
  const auto shown = ShownNumbers(html);
  for (const auto& [pointer, value_and_text] : shown) {
    INFO(pointer);
    CHECK(Json::parse(value_and_text.first) == At(Summary(), pointer));
  }
  CHECK(shown.at("/placed").second == "6");
  CHECK(shown.at("/first_attempt/k").second == "5");
  CHECK(shown.at("/first_attempt/wilson95/0").second == "43.6");
  CHECK(shown.at("/success/wilson95/1").second == "87.9");
  CHECK(shown.at("/sim_s").second == "412.2");  // Even: as printf rounds.
  CHECK_THAT(html, Contains("<span data-share=\"/first_attempt\">83.3</span>"));
  CHECK_THAT(html, Contains("The bin was not emptied."));
  CHECK(html.find("<h1>") < html.find("<h2>"));
}

TEST_CASE("every attempt has its row with what was chosen and why") {
  Json simulated = PlacedRow();
  simulated["used_simulator"] = true;
  simulated["class"] = "strong";
  simulated["motion"]["name"] = "escape";
  const std::string html = RoundReportHtml(Input({PlacedRow(), simulated, BareRow()}));
  CHECK_THAT(html, Contains("up: nothing lies over it, no simulation needed"));
  CHECK_THAT(html, Contains("escape: least displacement of the other tubes"));
  CHECK_THAT(html, Contains("one, 0.54&nbsp;N"));
  CHECK_THAT(html, Contains("plus45: several"));
}

TEST_CASE("every text is escaped, and a policy forbids all but inline style and script") {
  Json row = PlacedRow();
  row["motion"]["name"] = "<b>";
  row["class"] = "\"'><i>";
  row["outcome"] = "nothing_held<img src=x>";
  row["success"] = false;
  RoundReportInput input = Input({row, BareRow()});
  input.summary["end_reason"] = "</p><img src=x onerror=alert(1)>";
  const std::string html = RoundReportHtml(input);
  const std::string markup = Markup(html);
  CHECK_THAT(markup, !Contains("<img") && !Contains("<b>") && !Contains("<i>") &&
                         !Contains("http:") && !Contains("https:"));
  CHECK_THAT(markup, Contains("&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt; &amp; "
                              "&quot;more&quot;"));
  CHECK_THAT(markup, Contains("<meta http-equiv=\"Content-Security-Policy\" content=\"default-src "
                              "'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "));
  CHECK(html.find("<img src=x") == std::string::npos);  // Nor in the scripts' data.
  CHECK(UnbalancedTags(markup).empty());
}

TEST_CASE("JSON inside a script element cannot end it and stays the same JSON") {
  const Json evil{{"</script><!--", "a\xe2\x80\xa8z & <b> \" \\ \x01"}, {"n", 0.1}};
  const std::string text = ScriptJson(evil);
  CHECK(text.find_first_of("<>&") == std::string::npos);
  CHECK(std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; }));
  CHECK(Json::parse(text) == evil);
  CHECK_NOTHROW(Json::parse(ScriptJson(Json("no UTF-8: \xff"))));
}

TEST_CASE("base 64 gives the vectors of RFC 4648") {
  CHECK(Base64("") == "");
  CHECK(Base64("f") == "Zg==");
  CHECK(Base64("fo") == "Zm8=");
  CHECK(Base64("foo") == "Zm9v");
  CHECK(Base64("foobar") == "Zm9vYmFy");
  CHECK(Base64(std::string("\xff\xfe\x00", 3)) == "//4A");
}

TEST_CASE("the time table adds up, computing included when timings are given") {
  RoundReportInput input = Input({PlacedRow(), BareRow()});
  const auto row = [](const std::string& name, const std::string& each, const std::string& all,
                      const std::string& share) {
    return "<tr><th>" + name + "</th><td class=\"n\">" + each + "</td><td class=\"n\">" + all +
           "</td><td class=\"n\">" + share + "&nbsp;%</td></tr>";
  };
  std::string html = RoundReportHtml(input);
  CHECK_THAT(html, Contains(row("scan", "10.00", "20.0", "43")));
  CHECK_THAT(html, Contains(row("total", "23.00", "46.0", "100")));
  input.timings = {Json{{"compute_s", {{"modelling", 3.0}, {"evaluator", 1.0}}}}, Json::object()};
  html = RoundReportHtml(input);
  CHECK_THAT(html, Contains(row("computing: modelling", "1.50", "3.0", "6")));
  CHECK_THAT(html, Contains(row("total", "25.00", "50.0", "100")));
}

TEST_CASE("belief is set against truth, unknown where a cell has none") {
  Json wrong = PlacedRow();
  wrong["success"] = false;
  const std::string html = RoundReportHtml(Input({PlacedRow(), wrong, BareRow()}));
  CHECK_THAT(html, Contains("<tr><th>placed</th><td class=\"n\">1</td><td class=\"n\">1</td>"
                            "<td class=\"n\">0</td></tr>"));
  CHECK_THAT(html, Contains("<tr><th>no plan</th><td class=\"n\">0</td><td class=\"n\">0"
                            "</td><td class=\"n\">1</td></tr>"));
}

TEST_CASE("what a result folder holds is shown, what it lacks is left out") {
  const TemporaryFolder folder;
  WriteJsonFile(Summary(), folder / "summary.json");
  Json failed = PlacedRow();
  failed["outcome"] = "nothing_held";
  failed["success"] = false;
  failed["truth"]["placed_ids"] = Json::array();
  WriteJsonLines({failed, PlacedRow()}, folder / "picks.jsonl");
  const std::string page = folder / "report.html";
  const std::size_t bytes = WriteRoundReport(folder.path(), page, false);
  CHECK(bytes == std::filesystem::file_size(page));
  CHECK_THAT(ReadFile(page), !Contains("id=\"stage\"") && !Contains("video.mp4") &&
                                 Contains("<h3>nothing held</h3>"));

  WriteRecording(SmallRecording(2), folder / "recording.bin");
  WriteFileAtomically(folder / "picture.png", "picture");
  WriteFileAtomically(folder / "failures/attempt_001/film.mp4", "film");
  WriteRoundReport(folder.path(), page, false);
  const std::string html = ReadFile(page);
  CHECK_THAT(html, Contains("id=\"stage\"") && Contains(Base64("picture")) &&
                       Contains("<a href=\"failures/attempt_001/film.mp4\">film</a>") &&
                       Contains("tubetwin run config.resolved.toml --video --out again"));
  // The failed one comes first, both have their load; one of them its plan in the gallery.
  CHECK(html.find(">attempt 1: nothing held</option>") < html.find(">attempt 2: success</option>"));
  CHECK(CountOf(html, "<svg class=\"trace\"") == 3);
  CHECK(CountOf(html, "<svg class=\"plan\"") == 1);
  CHECK(CountOf(html, "<svg class=\"chart-svg\"") + CountOf(html, "<svg class=\"wide-chart\"") >=
        2);

  // Written again: the same bytes. From elsewhere: links that lead back.
  const std::string elsewhere = folder / "pages/round.html";
  WriteRoundReport(folder.path(), page, false);
  CHECK(ReadFile(page) == html);
  WriteRoundReport(folder.path(), elsewhere, false);
  CHECK_THAT(ReadFile(elsewhere), Contains("href=\"../failures/attempt_001/film.mp4\""));
}

TEST_CASE("a folder that is no round's, or damaged, is refused with its reason") {
  const TemporaryFolder folder;
  const auto refused = [&](ErrorKind kind, const std::string& said) {
    try {
      WriteRoundReport(folder.path(), folder / "report.html", false);
      FAIL("not refused");
    } catch (const Error& e) {
      CHECK(e.kind() == kind);
      CHECK_THAT(e.what(), Contains(said));
    }
  };
  refused(ErrorKind::kMissing, "summary.json");
  WriteJsonFile(Json{{"schema", "tubetwin/pile/1"}}, folder / "summary.json");
  refused(ErrorKind::kBadData, "tubetwin/summary/1");
  WriteJsonFile(Summary(), folder / "summary.json");
  WriteFileAtomically(folder / "picks.jsonl", "{}\n{\"round\":\n");
  refused(ErrorKind::kBadData, "picks.jsonl:2");
  CHECK_FALSE(std::filesystem::exists(folder / "report.html"));
}

TEST_CASE("a round without attempts still gives a page") {
  CHECK_THAT(RoundReportHtml(Input({})),
             Contains("There was no attempt.") && Catch::EndsWith("</html>\n"));
}

TEST_CASE("the bars of the chart stand on each other and stay inside the picture") {
  const std::string svg = TimeChartSvg({{{10, 20, 5, 1}, true}, {{10, 0, 0, 0}, false}, {}});
  CHECK(CountOf(svg, "<rect") == 12);
  // 36 s is the longest bar, the axis ends at 40 s: 202 px high, 222 px the base line.
  CHECK_THAT(svg, Contains("class=\"part0\" x=\"158.3\" y=\"171.5\" width=\"60.0\" "
                           "height=\"50.5\""));
  CHECK_THAT(svg, Contains("class=\"part1\" x=\"158.3\" y=\"70.5\" width=\"60.0\" "
                           "height=\"101.0\""));
  CHECK(CountOf(svg, "mark bad") == 1);
  CHECK(TimeChartSvg({}).empty());
  CHECK(TimeChartSvg({{}}).empty());
}

TEST_CASE("intervals are drawn on an axis that begins below all of them") {
  IntervalSeries series{"a <b>", {{7, 0.9, 0.8, 0.95, "hint"}, {6, 1.0, 0.9, 1.0, ""}}};
  const std::string svg = IntervalChartSvg({series}, "tubes left");
  CHECK_THAT(svg, Contains(">80 %</text>") && !Contains(">70 %</text>") && Contains(">7</text>"));
  // 200 px for 20 %: the share of 0.9 lies in the middle, 110 px from the top.
  CHECK_THAT(svg, Contains("cy=\"110.0\" r=\"4\""));
  CHECK(IntervalChartSvg({}, "x").empty());
  CHECK_THAT(BarsSvg({{"a <b>", {3.0}, "3"}}, {"bad-bar"}, "t"), Contains("a &lt;b&gt;"));
  CHECK(BarsSvg({{"a", {0.0}, "0"}}, {"bad-bar"}, "t").empty());
}

}  // namespace tubetwin
