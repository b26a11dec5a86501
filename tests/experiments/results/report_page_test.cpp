// Pages: oracles are the vectors of RFC 4648, and the page taken apart again.
#include "experiments/results/report_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <regex>
#include <string>

#include "experiments/results/gnuplot_axes.hpp"
#include "experiments/results/page/figure_data.hpp"
#include "experiments/results/page/swing_model.hpp"
#include "experiments/studies/report/report.hpp"
#include "tests/experiments/results/temporary_folder.hpp"

namespace beamid::experiments::report_page_test {
namespace {

using testing::HasSubstr, testing::Not;

TEST(Base64, GivesThePublishedVectors) {
  const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : vectors) EXPECT_EQ(base64(bytes), text);
}

TEST(EscapedText, ShowsWhatHtmlWouldTakeForItsOwn) {
  EXPECT_EQ(escaped("K < 3 & \"ξ\" > 2"), "K &lt; 3 &amp; &quot;ξ&quot; &gt; 2");
  EXPECT_EQ(escaped("a\xff\xc3\x1b[2J"), "aÿÃ[2J");
  // Unicode's bidirectional algorithm: a number behind Hebrew would stand at its left.
  EXPECT_EQ(escaped("\u05d0\u05d1 \u05d2: 12 \u0627"), "\u05d0\u05d1 \u05d2\u200e: 12 \u0627\u200e");
  EXPECT_EQ(escaped(unescaped(escaped("\u05d0 1"))), escaped("\u05d0 1"));
  for (const std::string text : {"&lt;", "<&>\"", "plain", "&amp;lt;"})
    EXPECT_EQ(unescaped(escaped(text)), text);
}

Results small_results(double stiffness) {
  Results results;
  results.command = "identify";
  results.command_line = "beamid identify 'my record.csv' --config a.toml";
  results.heading("A beam & its <record>");
  results.paragraph("First line\nand second");
  Table table{"parameters", "Parameters"};
  table.column({"name", "name"}).column({"K [N/m]", "stiffness_n_per_m", "{:.2f}"});
  table.row({"K", stiffness}).row({"none", std::numeric_limits<double>::quiet_NaN()});
  results.table(std::move(table));
  results.values["stiffness_n_per_m"] = stiffness;
  results.values["samples"] = 12;
  return results;
}

TEST(ReportPage, HoldsAllThatWasPrintedAndNeedsNoNetwork) {
  const std::string page = report_page({report_section(small_results(509.394), ".")});
  for (const char* text : {"<h1>A beam &amp; its &lt;record&gt;</h1>",
                           "<pre class=\"command\">beamid identify 'my record.csv' --config a.toml</pre>",
                           "<p>First line\nand second</p>", "<th class=\"number\">K [N/m]</th>",
                           "<td class=\"number\">509.39</td>", "<td class=\"number\">-</td>"})
    EXPECT_THAT(page, HasSubstr(text));
  for (const char* outside : {"http:", "https:", "src=\"/", "@import", "url(\"", "url(h"})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
}

TEST(ReportPage, IsTakenApartAgain) {
  const std::vector<ReportSection> sections{report_section(small_results(1.0), "."),
                                            {"Two", "<h1>Two</h1>\n<p>x</p>\n"}};
  const std::vector<ReportSection> found = sections_of(report_page(sections));
  ASSERT_EQ(found.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(found[i].title, sections[i].title);
    EXPECT_EQ(found[i].html, sections[i].html);
  }
  EXPECT_TRUE(sections_of("<html><h1>another page</h1></html>").empty());
}

// A page alone has its contents behind the verdict, a joined one before its sections.
TEST(ReportPage, HasContentsBehindTitleAndVerdictAndIsTakenApartWithoutThem) {
  Results results = small_results(1.0);
  for (const char* heading : {"The finding", "Tables", "Doubts"}) results.heading(heading);
  const ReportSection section = report_section(results, ".");
  const std::string page = report_page({section}), joined = report_page({section, section});
  EXPECT_THAT(page, HasSubstr("<body class=\"listed\">"));
  EXPECT_LT(page.find("class=\"verdict"), page.find("<nav"));
  EXPECT_LT(page.find("<nav"), page.find("First line"));
  EXPECT_LT(joined.find("<nav"), joined.find("<h1>"));
  for (const std::string& whole : {page, joined}) {
    const std::vector<ReportSection> found = sections_of(whole);
    EXPECT_EQ(found.at(0).html, section.html);
    EXPECT_EQ(report_page(found), whole);
  }
}

TEST(ReportPage, ShowsWarningsAndFailuresInBoxes) {
  Results results = small_results(1.0);
  results.warning("Two modes beat.");
  EXPECT_THAT(report_section(results, ".").html, HasSubstr("<p class=\"warning\">Two modes beat.</p>"));
  EXPECT_THAT(report_section(results, ".").html, Not(HasSubstr("class=\"failure\"")));
  results.warning("DIVERGED: the damping ratio is -0.87 %.", true);
  EXPECT_THAT(report_section(results, ".").html, HasSubstr("<p class=\"failure\" role=\"alert\">DIVERGED"));
}

TEST(ReportPage, SaysHowItWasMadeAndNoDate) {
  Results results = small_results(1.0);
  results.experiment_file = "[beam]\nlength_m = 1.1  # <tip>\n";
  results.seed = 7;
  const std::string html = report_section(results, ".").html;
  EXPECT_THAT(html, HasSubstr("<pre>[beam]\nlength_m = 1.1  # &lt;tip&gt;\n</pre>"));
  EXPECT_THAT(html, HasSubstr("Seed 7"));
  EXPECT_EQ(html, report_section(results, ".").html);
  EXPECT_EQ(foreign_tag(html), "");
}

TEST(ReportPage, ListsItsPartsAndLinksToEach) {
  Results results = small_results(1.0);
  results.heading("The finding");
  results.heading("Tables");
  const std::string page = report_page({report_section(results, ".")});
  EXPECT_THAT(page, HasSubstr("<li><a href=\"#section-1-2\">Tables</a></li>"));
  EXPECT_THAT(page, HasSubstr("<h2 id=\"section-1-2\">Tables</h2>"));
}

TEST(ReportPage, IsMadeForTheDarkForPaperAndForNarrowScreens) {
  const std::string page = report_page({report_section(small_results(1.0), ".")});
  for (const char* rule :
       {"@media screen and (prefers-color-scheme: dark)", "@media print",
        "@media screen and (max-width: 40rem)", ".scroll { overflow: visible }", "position: sticky"})
    EXPECT_THAT(page, HasSubstr(rule));
  EXPECT_THAT(page, Not(HasSubstr("break-before: page")));
}

/// Relative luminance of "#rgb" or "#rrggbb".
double luminance(std::string colour) {
  colour.erase(0, 1);
  if (colour.size() == 3) colour = {colour[0], colour[0], colour[1], colour[1], colour[2], colour[2]};
  const double weights[] = {0.2126, 0.7152, 0.0722};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double part = std::stoi(colour.substr(2 * i, 2), nullptr, 16) / 255.0;
    sum += weights[i] * (part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4));
  }
  return sum;
}

double contrast(const std::string& one, const std::string& other) {
  const auto [dark, bright] = std::minmax({luminance(one), luminance(other)});
  return (bright + 0.05) / (dark + 0.05);
}

// Oracle: WCAG 2.1 AA: 4.5 of text, 3 of what borders a button.
TEST(ReportPage, HasTextOfEnoughContrastBrightAndDark) {
  EXPECT_NEAR(contrast("#fff", "#767676"), 4.54, 0.01);  // the grey that is named everywhere
  const std::string style(page_style());
  static const std::regex scheme(R"(:root \{([^}]*)\})"), entry(R"(--([a-z-]+): (#[0-9a-f]+))");
  int schemes = 0;
  for (std::sregex_iterator one(style.begin(), style.end(), scheme), end; one != end; ++one, ++schemes) {
    const std::string body = (*one)[1];
    std::map<std::string, std::string> colours;
    for (std::sregex_iterator it(body.begin(), body.end(), entry), last; it != last; ++it)
      colours[(*it)[1]] = (*it)[2];
    for (const char* ground : {"ground", "soft", "warning-ground", "failure-ground", "good-ground"})
      for (const char* text : {"ink", "note", "link"})
        EXPECT_GE(contrast(colours.at(text), colours.at(ground)), 4.5) << text << " on " << ground;
    for (const std::string mark : {"warning", "failure", "good"})
      EXPECT_GE(contrast(colours.at(mark), colours.at(mark + "-ground")), 4.5) << mark;
    EXPECT_GE(contrast(colours.at("line"), colours.at("ground")), 3.0);
    EXPECT_GE(contrast(colours.at("line"), colours.at("soft")), 3.0);
  }
  EXPECT_EQ(schemes, 2);
}

TEST(ReportPage, BeginsWithAVerdictOfColourAndWord) {
  Results results = small_results(1.0);
  EXPECT_THAT(report_section(results, ".").html, HasSubstr("<p class=\"verdict good\"><b>No warnings.</b>"));
  results.limitation("Innovations: not white.");
  EXPECT_THAT(
      report_section(results, ".").html,
      HasSubstr("<p class=\"verdict doubtful\"><b>With reservations.</b> Innovations: not white.</p>"));
  EXPECT_TRUE(to_json(results)["messages"].empty());
  results.warning("Two modes beat.");
  EXPECT_THAT(report_section(results, ".").html,
              HasSubstr("<p class=\"verdict doubtful\"><b>With warnings.</b> Two modes beat."));
  results.warning("DIVERGED: <b>.", true);
  results.values["status"] = "diverged";
  EXPECT_THAT(report_section(results, ".").html,
              HasSubstr("<p class=\"verdict bad\"><b>Not to be used.</b> DIVERGED: &lt;b&gt;."));
  EXPECT_THAT(report_section(results, ".").html, HasSubstr("status: diverged"));
  EXPECT_EQ(foreign_tag(report_section(results, ".").html), "");
}

TEST(ReportPage, HasAVerdictOfWholeSentences) {
  Results results = small_results(1.0);
  const std::string first = "One mode lies at 1.25 Hz, " + std::string(150, 'x') + ".";
  results.warning(first + " And " + std::string(150, 'y') + ".");
  EXPECT_THAT(report_section(results, ".").html, HasSubstr("<b>With warnings.</b> " + first + "</p>"));
}

TEST(ReportPage, StatesAWarningOnceWhereTheVerdictHoldsItInFull) {
  Results results;
  results.command = "twins";
  results.warning("Six sets explain the modes.");
  const std::string html = report_section(results, ".").html;
  EXPECT_THAT(html, HasSubstr("<b>With warnings.</b> Six sets explain the modes."));
  EXPECT_THAT(html, Not(HasSubstr("class=\"warning\"")));
  results.warning("Another.");
  EXPECT_THAT(report_section(results, ".").html,
              HasSubstr("<p class=\"warning\">Six sets explain the modes.</p>"));
}

TEST(ReportPage, FoldsWhatComesAfterTheAnswerUnlessItWarns) {
  Results results = small_results(1.0);
  for (const char* heading : {"Details", "Doubts"}) results.heading(heading);
  results.warning("Two modes beat.");
  const std::string html = report_section(results, ".").html;
  EXPECT_THAT(html, HasSubstr("<details>\n<summary><h2>Details</h2>"));
  EXPECT_THAT(html, HasSubstr("<details open>\n<summary><h2>Doubts</h2>"));
}

// The one script that may run is the one whose hash the policy names.
TEST(ReportPage, LetsNoOtherScriptRun) {
  const PageScript script = page_script();
  const std::string page = report_page({report_section(small_results(1.0), ".")});
  EXPECT_THAT(page, HasSubstr("script-src " + script.policy + "\""));
  EXPECT_EQ(script.policy.size(), std::string("'sha256-'").size() + 44);
  EXPECT_EQ(page.find("<script"), page.rfind("<script"));
  EXPECT_THAT(page, HasSubstr(script.element));
}

// Oracle: the grammar of paths (SVG 1.1, 8.3), by hand: to a tenth of a pixel, from the rounded point before.
TEST(PictureAddress, HoldsThePictureInFewerBytes) {
  const std::string found = picture_address(
      "<path d='M10.04,5.00 L10.50,4.96\n\t\tL10.96,5.46  ' fill=\"#fff\"/>\n <path  d='M1,2 C3,4 5,6 "
      "7,8'/><a d='M-1,0 L0,0 "
      "Z L2,2'/><a d='M1.0,-0.04 L1.06,3 Z'/>");
  EXPECT_EQ(found,
            "data:image/svg+xml,%3Cpath d='M10 5l.5 0l.5 .5' fill=%22%23fff%22/%3E %3Cpath d='M1,2 C3,4 5,6 "
            "7,8'/%3E%3Ca d='M-1,0 L0,0 "
            "Z L2,2'/%3E%3Ca d='M1 0l.1 3z'/%3E");
}

Figure drawn_figure(Eigen::Index samples) {
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(samples, 0, 10);
  const Eigen::VectorXd motion = (3 * time).array().sin();
  return {"motion", {Panel{"</script>", {"time [s]"}, {"w [m]", true}}.line("\"<b>", time, motion)}};
}

/// The JSON in the first attribute. RFC 4648 by hand.
nlohmann::json figure_json(const std::string& attributes) {
  constexpr std::string_view before = " data-figure=\"",
                             digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::string text =
      attributes.substr(before.size(), attributes.find('"', before.size()) - before.size());
  std::string bytes;
  unsigned bits = 0, held = 0;
  for (const char letter : text) {
    if (letter == '=') break;
    held = held << 6 | static_cast<unsigned>(digits.find(letter));
    if ((bits += 6) >= 8) bytes += static_cast<char>(held >> (bits -= 8) & 255);
  }
  return nlohmann::json::parse(bytes);
}

TEST(ReportPage, HasFiguresBehindTheTablesOfTheAnswerAndBeforeRemarks) {
  Results results = small_results(1.0);
  results.paragraph("The noise is white.");
  results.figures.push_back(drawn_figure(101));
  const std::string html = report_section(results, ".").html;
  EXPECT_LT(html.find("</table>"), html.find("<h2>Figures</h2>"));
  const std::size_t remarks = html.find("<summary><h2>Remarks</h2></summary>\n<p>The noise is white.</p>");
  EXPECT_NE(remarks, std::string::npos);
  EXPECT_LT(html.find("<h2>Figures</h2>"), remarks);
}

TEST(ReportPage, IsEntitledByExperimentAndCommandWhereTheVerdictComesFirst) {
  Results results;
  results.command = "update";
  results.configuration["title"] = "four <storeys>";
  results.paragraph("One set explains the modes.");
  results.heading("Parameters");
  Table table{"parameters", ""};
  table.column({"K [N/m]", "stiffness_n_per_m", "{:.2f}"}).row({1.0});
  results.table(std::move(table));
  results.heading("Modes");
  const ReportSection section = report_section(results, ".");
  EXPECT_EQ(section.title, "four <storeys>: update");
  EXPECT_THAT(section.html, HasSubstr("<h1>four &lt;storeys&gt;: update</h1>"));
  EXPECT_THAT(section.html, HasSubstr("</p>\n<h2>Parameters</h2>\n"));
  EXPECT_THAT(section.html, HasSubstr("<summary><h2>Modes</h2></summary>"));
  results.configuration.erase("title");
  EXPECT_EQ(report_section(results, ".").title, "beamid update");
}

TEST(FigureAttributes, HoldWhatAClickShows) {
  Figure figure = drawn_figure(4);
  Panel& panel = figure.panels[0];
  panel.channels = {"<low>", "tip"};
  Curve& curve = panel.curves[0];
  curve.facts.push_back({"damping ratio [%]", Eigen::Vector4d(1, 2, 4, 7)});
  curve.shapes = Eigen::MatrixXcd::Constant(2, 4, {0.0, 3.0});
  curve.details.assign(4, {"set 1", {{"name", "value"}, {"K", "1.5"}}});
  curve.details[2].command = "beamid sweep";
  panel.curves.push_back(curve);
  const nlohmann::json found = figure_json(figure_attributes({figure}).at(0)), &first = found["panels"][0];
  EXPECT_EQ(first["channels"], nlohmann::json({"<low>", "tip"}));
  for (const nlohmann::json& one : first["curves"]) {
    EXPECT_EQ(one["facts"][0]["label"], "damping ratio [%]");
    EXPECT_EQ(one["facts"][0]["values"]["n"], 4);
    EXPECT_EQ(one["shapes"][1]["n"], 8);
    EXPECT_EQ(one["details"], nlohmann::json({0, 0, 1, 0}));  // the same text stands once
  }
  EXPECT_EQ(found["details"].size(), 2u);
  EXPECT_EQ(found["details"][1]["command"], "beamid sweep");
  EXPECT_EQ(found["details"][0]["rows"][1][1], "1.5");
}

TEST(FigureAttributes, KeepTheShapesOfThePolesInFrontWhereThereAreTooMany) {
  Figure figure = drawn_figure(4);
  Panel& panel = figure.panels[0];
  panel.curves.assign(3, panel.curves[0]);
  for (Curve& curve : panel.curves) curve.shapes = Eigen::MatrixXcd::Ones(2000, 4);
  const nlohmann::json curves = figure_json(figure_attributes({figure}).at(0))["panels"][0]["curves"];
  EXPECT_FALSE(curves[0].contains("shapes"));
  EXPECT_TRUE(curves[1].contains("shapes"));
  EXPECT_TRUE(curves[2].contains("shapes"));
}

TEST(FigureAttributes, KeepLogarithmicAxesAndStateEquallySpacedTimesByTheirStep) {
  const std::string attributes = figure_attributes({drawn_figure(101)}).at(0);
  EXPECT_EQ(attributes.find_first_of("<>"), std::string::npos);
  const nlohmann::json figure = figure_json(attributes);
  const nlohmann::json& panel = figure["panels"][0];
  EXPECT_EQ(panel["title"], "</script>");
  EXPECT_EQ(panel["x"]["log"], false);
  EXPECT_EQ(panel["y"]["log"], true);
  EXPECT_EQ(panel["curves"][0]["x"]["n"], 101);
  EXPECT_DOUBLE_EQ(panel["curves"][0]["x"]["step"], 0.1);
  EXPECT_EQ(panel["curves"][0]["y"]["size"], 8);
  EXPECT_FALSE(figure.contains("thinned"));
}

Figure noisy_figure(Eigen::Index samples) {
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(samples, 0, 10),
                        noise = Eigen::VectorXd::Random(samples);
  return {"noise", {Panel{"", {"time [s]"}, {"w [m]"}}.line("", time, noise)}};
}

// Of equally spaced samples the page holds all up to 375 000 of 2 bytes (as base64), of a million an
// envelope.
TEST(FigureAttributes, KeepEverySampleAsLongAsTwoBytesOfEachFit) {
  const nlohmann::json all = figure_json(figure_attributes({noisy_figure(300'000)}).at(0));
  EXPECT_EQ(all["panels"][0]["curves"][0]["y"]["n"], 300'000);
  EXPECT_EQ(all["panels"][0]["curves"][0]["y"]["size"], 2);
  EXPECT_EQ(all["thinned"],
            "All 300000 points of the longest curve are here, rounded to 1/65 534 of their range.");
  const std::string attributes = figure_attributes({noisy_figure(1'000'000)}).at(0);
  EXPECT_LE(attributes.size(), most_page_bytes);
  EXPECT_GT(attributes.size(), most_page_bytes / 2);
  const nlohmann::json figure = figure_json(attributes), &curve = figure["panels"][0]["curves"][0];
  EXPECT_EQ(curve["x"]["size"], 1);
  EXPECT_EQ(curve["x"]["counts"], true);
  EXPECT_GT(curve["y"]["n"].get<int>(), 150'000);
  EXPECT_THAT(figure["thinned"].get<std::string>(), HasSubstr("1000000 points"));
}

// Six cycles at the beginning of a long record are shown by all their samples.
TEST(FigureAttributes, KeepWhatAPanelShowsAtFirst) {
  Figure figure = noisy_figure(200'000);
  figure.panels[0].across(2, 2.1);
  const nlohmann::json curve =
      figure_json(figure_attributes({figure}, 100'000).at(0))["panels"][0]["curves"][0];
  const auto count = curve["y"]["n"].get<int>();
  const nlohmann::json plain = figure_json(figure_attributes({noisy_figure(200'000)}, 100'000).at(0));
  EXPECT_GT(count, 2000 + plain["panels"][0]["curves"][0]["y"]["n"].get<int>() / 2);
  EXPECT_LT(count, 40'000);
}

// What is kept of a long curve shows the same picture: its intervals are parts of those of a picture.
TEST(Thinned, KeepsThePictureOfAMillionSamples) {
  Figure figure = noisy_figure(1'000'000);
  figure.panels[0].across(0, 10);
  const auto picture = [](const Curve& curve) {
    const Eigen::VectorXd y = curve.y(envelope(curve.x, curve.y, false));
    return std::vector<double>(y.begin(), y.end());
  };
  const Panel kept = thinned(figure.panels[0]);
  EXPECT_NEAR(static_cast<double>(kept.curves[0].x.size()), static_cast<double>(most_kept_points), 5.0);
  EXPECT_EQ(kept.curves[0].points, 1'000'000);
  EXPECT_EQ(picture(kept.curves[0]), picture(figure.panels[0].curves[0]));
}

// What `identify` draws of a record: the whole, its reproduction, and what is left, thin lines among them.
TEST(ReportPage, OfAMillionSamplesIsSmallAndStatesThatItShowsEnvelopes) {
  const Eigen::Index samples = 1'000'000;
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(samples, 0, 1000);
  const Eigen::VectorXd noise = Eigen::VectorXd::Random(samples),
                        motion = (19 * time).array().sin() + 0.1 * noise.array();
  Panel whole{"the whole window", {"time [s]"}, {"w [m]"}}, left{"residual", {"time [s]"}, {"w [m]"}};
  whole.line("reproduced", time, motion - 0.1 * noise).thin("measured", time, motion);
  left.thin("", time, 0.1 * noise);
  Panel start = whole;
  start.x_axis.range = {0.0, 2.0};
  Results results = small_results(1.0);
  results.figures = {{"reproduction", {start, whole, left}, 3}, {"convergence", {whole}}, {"noise", {left}}};
  TemporaryFolder folder;
  for (const Figure& figure : results.figures) write(figure, folder.path);
  EXPECT_LE(contents(folder.path / "reproduction.csv").size(), 1'000'000u);
  const std::string page = report_page({report_section(results, folder.path)});
  EXPECT_LE(page.size(), 1'500'000u);
  EXPECT_THAT(page, HasSubstr("The static picture and reproduction.csv show curves of up to 1000000 points "
                              "by 4000: the lowest and the highest of each interval."));
}

// What the frame cannot show of a curve is no reason for a note.
TEST(ThinningText, CountsWhatTheFrameShows) {
  Figure figure = drawn_figure(100'001);
  EXPECT_THAT(thinning_text(figure), HasSubstr("100001 points by 4000"));
  figure.panels[0].x_axis.range = {0.0, 0.1};
  EXPECT_EQ(thinning_text(figure), "");
  figure.panels[0].x_axis.range.reset();
  figure.panels[0].curves[0].style = CurveStyle::points;
  EXPECT_EQ(thinning_text(figure), "");
}

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, 4);
  return word;
}

// Oracle: the layout of the glTF 2.0 specification, read back.
TEST(BinaryGltf, HoldsAnAnimationForEachModeAndPhasesOfComplexOnes) {
  SwingModel model;
  Eigen::Matrix3Xd points(3, 2), motion(3, 2);
  points << 0, 2, 0, 0, 0, 0;
  motion << 0, 0, 0, 0, 0, 1;
  model.parts = {{SwingModel::Kind::lines, points, {0, 1}, {motion, -motion}}};
  model.modes = {{"mode 1", 3.5, 0.01, 0, {}}, {"mode 2", 7.0, {}, 0, 1}};
  const std::string bytes = binary_gltf(model);
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(word_at(bytes, 4), 2u);
  EXPECT_EQ(word_at(bytes, 8), bytes.size());
  const std::size_t length = word_at(bytes, 12), start = 20 + length + 8;
  const nlohmann::json json = nlohmann::json::parse(bytes.substr(20, length));
  EXPECT_EQ(json["animations"].size(), 2u);
  EXPECT_EQ(json["buffers"][0]["byteLength"], bytes.size() - start);
  const auto numbers = [&](std::size_t accessor) {
    const nlohmann::json& view = json["bufferViews"][json["accessors"][accessor]["bufferView"].get<int>()];
    std::vector<float> values(view["byteLength"].get<std::size_t>() / 4);
    std::memcpy(values.data(), bytes.data() + start + view["byteOffset"].get<std::size_t>(),
                4 * values.size());
    return values;
  };
  // y is upwards; a tenth of the extent of 2 m.
  const nlohmann::json& primitive = json["meshes"][0]["primitives"][0];
  EXPECT_THAT(numbers(primitive["attributes"]["POSITION"]), testing::ElementsAre(0, 0, 0, 2, 0, 0));
  EXPECT_THAT(numbers(primitive["targets"][0]["POSITION"]),
              testing::ElementsAre(0, 0, 0, 0, testing::FloatEq(0.2f), 0));
  // A quarter of a period later the mode that is complex stands at minus its imaginary part.
  const std::vector<float> weights = numbers(json["animations"][1]["samplers"][0]["output"]);
  EXPECT_FLOAT_EQ(weights[0], 1);
  EXPECT_NEAR(weights[2 * 8], 0, 1e-6);
  EXPECT_FLOAT_EQ(weights[2 * 8 + 1], -1);
  model.parts[0].corners = {0, 2};
  EXPECT_THROW(binary_gltf(model), std::invalid_argument);
}

// Oracle: the same layout; a motion of two shapes at three instants, largest 4 mm, drawn as a tenth of 2 m.
TEST(BinaryGltf, HoldsAMotionAtItsOwnSpeed) {
  SwingModel model;
  Eigen::Matrix3Xd points(3, 2), motion(3, 2);
  points << 0, 2, 0, 0, 0, 0;
  motion << 0, 0, 0, 0, 0, 1;
  model.parts = {{SwingModel::Kind::lines, points, {0, 1}, {motion, -motion}}};
  MotionHistory history{Eigen::Vector3d(1.0, 1.5, 2.0), Eigen::MatrixXd::Zero(2, 3), 0.004, 0.02};
  history.weights << 0.004, 0, -0.002, 0, 0.001, 0;
  const std::string bytes = binary_gltf(model, history);
  const std::size_t length = word_at(bytes, 12), start = 20 + length + 8;
  const nlohmann::json json = nlohmann::json::parse(bytes.substr(20, length));
  EXPECT_EQ(json["animations"].size(), 1u);
  EXPECT_EQ(json["meshes"][0]["extras"]["motion"]["largest_m"], 0.004);
  const auto number = [&](const char* end, std::size_t place) {
    const int accessor = json["animations"][0]["samplers"][0][end].get<int>();
    float value = 0;
    std::memcpy(
        &value,
        bytes.data() + start + json["bufferViews"][accessor]["byteOffset"].get<std::size_t>() + 4 * place, 4);
    return value;
  };
  EXPECT_FLOAT_EQ(number("input", 1), 1.5f);
  EXPECT_FLOAT_EQ(number("output", 0), 1.0f);
  EXPECT_FLOAT_EQ(number("output", 3), 0.25f);
  EXPECT_FLOAT_EQ(number("output", 4), -0.5f);
  history.weights.conservativeResize(1, 3);
  EXPECT_THROW(binary_gltf(model, history), std::invalid_argument);
  EXPECT_THROW(binary_gltf(model), std::invalid_argument);
}

// Oracle: the widths. A figure space is as wide as a digit, a punctuation space as a point.
TEST(HtmlTable, PutsDecimalPointsBelowEachOther) {
  Table table{"t", ""};
  table.column({"estimate", "estimate"}).column({"what", "what"});
  table.row({"3.4555", "f"}).row({"-0.45", "xi"}).row({"12", "n"}).row({"-", "1.0 to 2.0"});
  const std::string html = html_table(table);
  EXPECT_THAT(html, HasSubstr("<td class=\"number\">-0.45<span class=\"pad\">\u2007\u2007</span></td>"));
  EXPECT_THAT(html, HasSubstr("12<span class=\"pad\">\u2008\u2007\u2007\u2007\u2007</span></td>"));
  EXPECT_THAT(html, HasSubstr("<td>1.0 to 2.0</td>"));
}

TEST(Typeset, RaisesExponentsOfUnitsAndLeavesNames) {
  EXPECT_EQ(typeset("acceleration [m/s2]"), "acceleration [m/s²]");
  EXPECT_EQ(typeset("EI [N m2], 0.00122 m2, N s2/m2"), "EI [N m²], 0.00122 m², N s²/m²");
  EXPECT_EQ(typeset("10^-8, chi^2 = 3, 5 +- 1"), "10⁻⁸, χ² = 3, 5\u00a0±\u00a01");
  for (const char* name : {"sensor m2", "m2", "test s2.csv", "massa1_test1-1", "^2", "a+b"})
    EXPECT_EQ(typeset(name), name);
}

nlohmann::ordered_json compared(double rayleigh, double modal, bool turned) {
  const auto run = [](const char* reduction, double value) {
    return nlohmann::ordered_json{
        {"reduction", reduction},
        {"filter", "ekf"},
        {"diagnostics", {{"whiteness", {{{"autocorrelation", {value, 0.5}}}}}}},
        {"parameters",
         {{"bending_stiffness", {{"unit", "N m2"}, {"estimate", value}, {"standard_deviation", 0.3}}}}},
        {"response_error_percent", value / 10}};
  };
  nlohmann::ordered_json json{{"command", "compare"},
                              {"configuration", {{"filter", {{"passes", turned ? 2 : 1}}}}}};
  json["runs"] = turned ? nlohmann::ordered_json{run("modal_truncation", modal), run("rayleigh", rayleigh)}
                        : nlohmann::ordered_json{run("rayleigh", rayleigh), run("modal_truncation", modal)};
  return json;
}

// Oracle: by hand, (221 - 220) / sqrt(0.3^2 + 0.3^2) = 2.357. The runs stand in another order in the second
// file.
TEST(SideBySide, JoinsRunsByTheirNames) {
  const Table table =
      parameters_side_by_side({{"a", compared(220, 229, false)}, {"b", compared(221, 229, true)}});
  ASSERT_EQ(table.rows(), 2u);
  EXPECT_EQ(std::get<std::string>(table.columns[0].cells[0]), "rayleigh, ekf: bending stiffness [N m2]");
  EXPECT_EQ(std::get<std::string>(table.columns[1].cells[0]), "220.00 +- 0.59");
  EXPECT_NEAR(std::get<double>(table.columns[4].cells[0]), 2.357, 1e-3);
  EXPECT_EQ(std::get<double>(table.columns[4].cells[1]), 0.0);
}

TEST(SideBySide, LeavesHistoriesAndListsOut) {
  const std::vector<NamedResults> both{{"a", compared(220, 229, false)}, {"b", compared(221, 229, true)}};
  for (const bool all : {false, true}) {
    const Table table = numbers_side_by_side(both, all);
    ASSERT_EQ(table.rows(), 1u);
    EXPECT_EQ(std::get<std::string>(table.columns[0].cells[0]), "rayleigh, ekf: response error [%]");
  }
}

// A mode that one record lacks must not shift the others.
TEST(SideBySide, JoinsModesByFrequency) {
  const auto mode = [](double frequency) {
    return nlohmann::ordered_json{{"frequency_hz", frequency}, {"frequency_standard_deviation_hz", 0.01}};
  };
  const nlohmann::ordered_json one{{"modes", {mode(3.46), mode(22.8), mode(65.7)}}},
      two{{"modes", {mode(22.9), mode(65.8)}}};
  const Table table = parameters_side_by_side({{"one", one}, {"two", two}});
  ASSERT_EQ(table.rows(), 2u);
  EXPECT_EQ(std::get<std::string>(table.columns[0].cells[0]), "mode at 22.8 Hz: frequency [Hz]");
}

TEST(SideBySide, ShowsTheNumbersThatDiffer) {
  const Table table = numbers_side_by_side(
      {{"one", to_json(small_results(500.0))}, {"two", to_json(small_results(505.0))}}, false);
  ASSERT_EQ(table.rows(), 1u);
  EXPECT_EQ(std::get<std::string>(table.columns[0].cells[0]), "stiffness [N/m]");
  EXPECT_NEAR(std::get<double>(table.columns[3].cells[0]), 1.0, 1e-12);
}

}  // namespace
}  // namespace beamid::experiments::report_page_test
