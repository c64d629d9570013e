#include "twin/report/report_page.h"

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
#include "twin/report/write_report.h"
#include "twin/round/result_files.h"

namespace tubetwin {
namespace {

using Catch::Contains;

RoundSummary Summary() {
  RoundSummary summary;
  summary.tubes_start = 7;
  summary.placed = 6;
  summary.attempts = 9;
  summary.success = Counts{6, 9};
  summary.first_attempt = {5, 6};
  summary.end = RoundEnd::kNoPlan;
  summary.end_detail = "tube 3 <under> the wall";
  summary.dropped = 1;
  summary.sim_s = 412.25;
  return summary;
}

AttemptRecord Placed() {
  AttemptRecord attempt;
  attempt.tubes_in_bin = 7;
  attempt.chosen.emplace();
  attempt.chosen->target = 2;
  attempt.chosen->motion = "up";
  attempt.detection = Detection{HeldOutcome::kOne, 0.538, Vector3::Zero(), 1.5};
  attempt.outcome = AttemptOutcome::kPlaced;
  attempt.success = true;
  attempt.sim_s = AttemptReport::SimTime{10, 20, 5, 1};
  attempt.truth = AttemptTruth{1, {2}, {}, {}, {}};
  return attempt;
}

/// Of a cell without truth.
AttemptRecord Bare() {
  AttemptRecord attempt;
  attempt.tubes_in_bin = 1;
  attempt.resolution_used = true;
  attempt.strategy = "plus45";
  attempt.held_at_last = HeldOutcome::kSeveral;
  attempt.outcome = AttemptOutcome::kNoPlan;
  attempt.reason = "<script>alert('x')</script> & \"more\"";
  attempt.sim_s = AttemptReport::SimTime{10, 0, 0, 0};
  return attempt;
}

RoundRecord Round(std::vector<AttemptRecord> attempts) {
  RoundRecord record;
  record.summary = Summary();
  record.attempts = std::move(attempts);
  return record;
}

/// With a summary that tells what its attempts tell, as a folder must.
RoundRecord Whole(RoundRecord record) {
  const AttemptCounts rows = CountAttempts(record.attempts);
  record.summary.attempts = rows.attempts;
  record.summary.success = rows.success;
  record.summary.first_attempt = rows.first_attempt;
  record.summary.dropped = rows.dropped;
  return record;
}

std::string Page(const RoundRecord& record, bool computing_times = false) {
  return ReportHtml(RoundReportInput(record, computing_times), {}, RoundSummaryJson(record));
}

}  // namespace

TEST_CASE("a round's page leads with what was placed, its numbers are those of summary.json") {
  RoundRecord record = Round({Placed(), Placed(), Placed()});
  record.attempts[1].outcome = AttemptOutcome::kNothingHeld;
  record.attempts[1].success = false;
  record.attempts[2].attempt = 2;
  record.summary.success = Counts{2, 3};
  record.summary.first_attempt = {1, 2};
  record.summary.placed = 2;
  record.summary.attempts = 3;
  const std::string html = Page(record);
  const auto shown = ShownNumbers(html);
  for (const auto& [pointer, value_and_text] : shown) {
    INFO(pointer);
    CHECK(Json::parse(value_and_text.first) ==
          RoundSummaryJson(record).at(Json::json_pointer(pointer)));
  }
  CHECK(shown.at("/placed").second == "2");
  CHECK(shown.at("/first_attempt/k").second == "1");
  CHECK(shown.at("/success/wilson95/1").second == "93.9");
  CHECK(shown.at("/sim_s").second == "412.2");  // Even: as printf rounds.
  CHECK_THAT(html, Contains("<span data-share=\"/first_attempt\">50.0</span>"));
  CHECK_THAT(html, Contains("The bin was not emptied."));
  CHECK_THAT(html, Contains("id=\"credibility\"") && Contains("a single round states no rate") &&
                       Contains("one round cannot say how much rounds differ"));
  CHECK(html.find("<h1>") < html.find("<h2>"));
}

TEST_CASE("every attempt has its row with what was chosen and why") {
  AttemptRecord simulated = Placed();
  simulated.used_simulator = true;
  simulated.chosen->target_class = TubeClass::kStrong;
  simulated.chosen->motion = "escape";
  const std::string html = Page(Round({Placed(), simulated, Bare()}));
  CHECK_THAT(html, Contains("up: nothing lies over it, no simulation needed"));
  CHECK_THAT(html, Contains("escape: least displacement of the other tubes"));
  CHECK_THAT(html, Contains("one, 0.54&nbsp;N"));
  CHECK_THAT(html, Contains("plus45: several"));
}

TEST_CASE("every text is escaped, and a policy forbids all but inline style and script") {
  RoundRecord record = Round({Placed(), Bare()});
  record.attempts[0].chosen->motion = "<b>";
  record.attempts[1].strategy = "\"'><i>";
  record.summary.end_detail = "</p><img src=x onerror=alert(1)>";
  const std::string html = Page(record);
  const std::string markup = Markup(html);
  CHECK_THAT(markup, !Contains("<img") && !Contains("<b>:") && !Contains("<i>") &&
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

TEST_CASE("times are told of attempts, computing included when timings are asked for") {
  RoundRecord record = Round({Placed(), Bare()});
  record.timings = {{1, AttemptReport::ComputeTime{3.0, 0.5, 1.0, 4.5}, 60.0},
                    {1, std::nullopt, 10.0}};
  const auto row = [](const std::string& name, const std::string& mean) {
    return "<tr><th>" + name + "</th><td class=\"n\">" + mean + "</td>";
  };
  std::string html = Page(record);
  CHECK_THAT(html, Contains(row("move", "10.00")) && !Contains("computing: modelling"));
  CHECK_THAT(html, Contains(row("simulated, all of an attempt", "23.00")));
  html = Page(record, /*computing_times=*/true);
  CHECK_THAT(html, Contains(row("computing: modelling", "3.00")));
  CHECK_THAT(html, Contains(row("computing: total", "4.50")));
}

TEST_CASE("belief is set against truth, unknown where a cell has none") {
  AttemptRecord wrong = Placed();
  wrong.success = false;
  const std::string html = Page(Round({Placed(), wrong, Bare()}));
  CHECK_THAT(html, Contains("<tr><th>placed</th><td class=\"n\">1</td><td class=\"n\">1</td>"
                            "<td class=\"n\">0</td></tr>"));
  CHECK_THAT(html, Contains("<tr><th>no plan</th><td class=\"n\">0</td><td class=\"n\">0"
                            "</td><td class=\"n\">1</td></tr>"));
}

TEST_CASE("a round of a cell without truth tells what the pipeline believes, and says so") {
  AttemptRecord placed = Placed();
  placed.success = std::nullopt;
  placed.truth = std::nullopt;
  RoundRecord record = Round({placed});
  record.summary.success = std::nullopt;
  record.summary.first_attempt = {1, 1};
  const std::string html = Page(record);
  CHECK_THAT(html, Contains("The cell of this round has no truth") &&
                       Contains("<span data-share=\"/first_attempt\">100.0</span>") &&
                       !Contains("data-share=\"/success\""));
}

TEST_CASE("what a result folder holds is shown, what it lacks is left out") {
  const TemporaryFolder folder;
  AttemptRecord failed = Placed();
  failed.outcome = AttemptOutcome::kNothingHeld;
  failed.success = false;
  failed.truth->placed_ids.clear();
  WriteRoundRecord(Whole(Round({failed, Placed()})), folder.path());
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
                       Contains("<a href=\"./failures/attempt_001/film.mp4\">film</a>") &&
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
  WriteRoundRecord(Whole(Round({Placed()})), folder.path());
  const std::string good = ReadFile(folder / "picks.jsonl");
  WriteFileAtomically(folder / "picks.jsonl", good + "{\"round\":\n");
  refused(ErrorKind::kBadData, "picks.jsonl:2: not valid JSON at byte");
  WriteFileAtomically(folder / "picks.jsonl", good + "[]\n");
  refused(ErrorKind::kBadData, "picks.jsonl:2: not a JSON object");
  for (const char* key : {"attempt", "tubes_in_bin", "target", "used_simulator", "detection",
                          "resolution", "outcome", "reason", "success", "sim_s", "truth"}) {
    Json lacking = Json::parse(good);
    lacking.erase(key);
    WriteFileAtomically(folder / "picks.jsonl", good + lacking.dump() + "\n");
    refused(ErrorKind::kBadData, std::string("picks.jsonl:2: field '") + key + "' is missing");
  }
  Json row = Json::parse(good);
  row["detection"]["force_N"] = "heavy";
  WriteFileAtomically(folder / "picks.jsonl", good + row.dump() + "\n");
  refused(ErrorKind::kBadData, "picks.jsonl:2: detection.force_N: a number is needed");
  CHECK_FALSE(std::filesystem::exists(folder / "report.html"));
}

TEST_CASE("a link to a folder of any name leads there, and is never read as a script") {
  CHECK(LinkTo("film.mp4") == "./film.mp4");
  CHECK(LinkTo("../a b/film.mp4") == "../a%20b/film.mp4");
  CHECK(LinkTo("/x/50%#?&\"'<.mp4") == "/x/50%25%23%3F%26%22%27%3C.mp4");
  CHECK(LinkTo("javascript:alert(1)/video.mp4") == "./javascript%3Aalert%281%29/video.mp4");
  CHECK(LinkTo("//host/x") == "/host/x");
  const TemporaryFolder folder;
  const std::string round = folder / "javascript:alert(1);void(0)";
  WriteRoundRecord(Whole(Round({Placed()})), round);
  WriteFileAtomically(round + "/video.mp4", "film");
  WriteRoundReport(round, folder / "r.html", false);
  CHECK_THAT(ReadFile(folder / "r.html"),
             Contains("<a href=\"./javascript%3Aalert%281%29%3Bvoid%280%29/video.mp4\">The film") &&
                 !Contains("href=\"javascript"));
}

TEST_CASE("a round without attempts still gives a page") {
  RoundRecord none = Round({});
  none.summary.attempts = 0;
  CHECK_THAT(Page(none), Contains("There was no attempt.") && Catch::EndsWith("</html>\n"));
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
}

TEST_CASE("bars carry their whole name, however long") {
  const std::string name = "a <b> " + std::string(60, 'x');
  CHECK_THAT(BarsHtml({{name, {3.0}, "3"}}, {"bad-bar"}, "t"),
             Contains("a &lt;b&gt; " + std::string(60, 'x') + "</div>"));
  CHECK(BarsHtml({{"a", {0.0}, "0"}}, {"bad-bar"}, "t").empty());
}

TEST_CASE("a Gantt chart's bars begin where the ones before end") {
  const std::string html =
      GanttHtml({{"look", 0.0, 5.0, "part0"}, {"reach", 5.0, 20.0, "part1"}}, "t");
  CHECK_THAT(html, Contains("class=\"part0\" x=\"0.0\" y=\"0.0\" width=\"250.0\"") &&
                       Contains("class=\"part1\" x=\"250.0\" y=\"0.0\" width=\"750.0\"") &&
                       Contains(">15.0 s</div>"));
  CHECK(GanttHtml({}, "t").empty());
}

}  // namespace tubetwin
