#include "models/base/files.h"
#include "models/base/json.h"
#include "tests/campaign/fake_rounds.h"
#include "tests/report/report_fixture.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "twin/report/front/part_picture.h"
#include "twin/report/front/study_facts.h"
#include "twin/report/write_report.h"

namespace tubetwin {
namespace {

using Catch::Contains;

std::string CampaignPage(const Campaign& campaign, const ReportHead& head = {}) {
  const TemporaryFolder folder;
  RunAll(campaign, folder.path());
  WriteMerged(ReadShards({folder.path()}), folder.path());
  WriteCampaignReport(folder.path(), {}, folder / "report.html", head);
  return ReadFile(folder / "report.html");
}

}  // namespace

TEST_CASE("the first sheet says whom it is for, what was run and how many parts an hour") {
  const std::string html = Markup(CampaignPage(FakeCampaign(12), {"Hoses <b>", "ACME & Sons"}));
  CHECK_THAT(html, Contains("For ACME &amp; Sons") && Contains("<h1>Hoses &lt;b&gt;</h1>") &&
                       Contains("<title>Hoses &lt;b&gt;</title>"));
  CHECK_THAT(html, Contains("<h3>Parts per hour</h3>") &&
                       Contains("by a bootstrap over 12 rounds") &&
                       Contains(DefinitionOf(HourOf::kCellAndComputing)));
  CHECK_THAT(html, Contains("pvc_a, rigid, diameter 25 mm, length 500 mm, 55 g") &&
                       Contains("770 x 580 mm inside, walls 90 mm") && Contains("0.2 to 0.5") &&
                       Contains("all simulated") && Contains("Not modelled"));
  CHECK(CountOf(html, "part-picture\"") == 1);
  // It is one block, and the sections begin behind it.
  CHECK(html.find("class=\"front\"") < html.find("Not modelled"));
  CHECK(html.find("Not modelled") < html.find("id=\"cycle\""));
  CHECK(UnbalancedTags(html).empty());
}

TEST_CASE("the interval is told with what twice and four times the rounds would give") {
  const std::string html = Markup(CampaignPage(FakeCampaign(12)));
  CHECK_THAT(html, Contains("12 rounds, as run") && Contains("24 rounds") && Contains("48 rounds"));
  CHECK_THAT(html, !Contains("too narrow"));
  CHECK_THAT(Markup(CampaignPage(FakeCampaign(4))),
             Contains("of fewer than 10 rounds it is too narrow"));
  const std::string one = Markup(CampaignPage(FakeCampaign(1)));
  CHECK_THAT(one, Contains("there is no interval") && Contains("One round gives no interval"));
}

TEST_CASE("several variants are told each on its own, by their whole names") {
  Campaign campaign = FakeCampaign(6, 2);
  campaign.variants[0].name = "a name that is much longer than twenty letters and goes on";
  campaign.variants[0].scenario.bin.size_m = {0.6, 0.4, 0.2};
  const std::string html = Markup(CampaignPage(campaign));
  CHECK_THAT(html,
             Contains("<h1>2 variants compared</h1>") && !Contains("<h3>Parts per hour</h3>"));
  CHECK(CountOf(html, campaign.variants[0].name) > 5);
  CHECK(html.find("\xe2\x80\xa6") == std::string::npos);
  // Shared facts once, what differs for each.
  CHECK(CountOf(html, "all simulated") == 1);
  CHECK_THAT(html, Contains("600 x 400 mm inside, walls 200 mm") &&
                       Contains("770 x 580 mm inside, walls 90 mm"));
  for (const auto& [pointer, shown] : ShownNumbers(html)) {
    INFO(pointer);
    CHECK(pointer.rfind("/variants/", 0) == 0);  // Nothing of the mix.
  }
}

TEST_CASE("every page says how far to trust its rates, in a dozen lines at most") {
  const auto section = [](const std::string& html) {
    const std::size_t at = html.find("<section id=\"credibility\">");
    REQUIRE(at != std::string::npos);
    return html.substr(at, html.find("</section>", at) - at);
  };
  Campaign campaign = FakeCampaign(12);
  campaign.variants[0].part = LoadPart("hose_b");
  const std::string text = section(Markup(CampaignPage(campaign)));
  CHECK_THAT(text, Contains("were fitted to its rates of hoses that come along") &&
                       Contains("how often another comes along was fitted to this part") &&
                       Contains("friction of parts 0.8 to 1.2, of the pads 0.6 to 1, bending "
                                "stiffness 0.05 to 0.3 N m"));
  CHECK_THAT(text, Contains("tests/validation/VALIDATION.md") && Contains("interval by rounds") &&
                       Contains("the tolerance is 20&nbsp;mm and 10\xc2\xb0") &&
                       Contains("1, development: ") &&
                       Contains("Without measured materials and a real cell this verifies the "
                                "method, not your rate."));
  CHECK(CountOf(text, "<dt>") + CountOf(text, "<p>") <= 12);
  campaign.purpose = "claim";
  CHECK_THAT(section(Markup(CampaignPage(campaign))),
             Contains("nothing was run with this seed before"));
  const std::string several = section(Markup(CampaignPage(FakeCampaign(6, 2))));
  CHECK_THAT(several, Contains("of each variant in the table above"));
  StudySetup own;
  own.part.emplace();
  own.part->name = "mine";
  CHECK(StudyGrounds(own).at(0).second == "their source is not said (key source of the part file)");
  CHECK_THAT(StudyGrounds(own).at(1).second, Contains("fitted to hose_b, not to this part"));
}

TEST_CASE("failure modes have their rates with intervals") {
  const std::string html = Markup(CampaignPage(FakeCampaign(12)));
  CHECK_THAT(html,
             Contains("nothing held<span class=\"quiet block\">the fingers came up without") &&
                 Contains("95&nbsp;% interval"));
  CHECK_THAT(html, Contains("Most by this: <b>"));
}

TEST_CASE("facts that the files do not say are dashes, never guesses") {
  const StudySetup nothing;
  for (const auto& [name, text] : StudyFacts(nothing)) {
    INFO(name);
    CHECK_THAT(text, Contains("\xe2\x80\x93"));
  }
  StudySetup real;
  real.config["cell"]["arm"]["driver"] = "hses";
  CHECK_FALSE(IsSimulated(real));
  CHECK(StudyFacts(real).at(4).second ==
        "arm hses, gripper simulated, wrist simulated, scanner simulated");
  CHECK(StudyAssumptions(real).size() == 1);
}

TEST_CASE("numbers stand as people write them") {
  CHECK(PlainNumber(0.1 + 0.2) == "0.3");
  CHECK(PlainNumber(25.0) == "25");
  CHECK(PlainNumber(1e-4) == "0.0001");
}

TEST_CASE("a part is drawn to scale with its length along the picture") {
  // A bow of 100 mm: 348 px for its extent and a radius on either side.
  const std::string svg = PartPictureSvg({{{0, 0, 0}, {0, 0.05, 0.02}, {0, 0.1, 0}}}, 0.01);
  CHECK_THAT(svg,
             Contains("points=\"35.0,") && Contains("stroke-width=\"58.0\"") && Contains("325.0,"));
  CHECK_THAT(svg, Contains(">50 mm</text>"));
  CHECK(PartPictureSvg({}, 0.01).empty());
  CHECK(PartPictureSvg({{{0, 0, 0}}}, 0.01).empty());
}

}  // namespace tubetwin
