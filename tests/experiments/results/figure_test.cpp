#include "experiments/results/figure.hpp"

#include <gtest/gtest.h>
#include <vtkNew.h>
#include <vtkXMLParser.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <set>

#include "experiments/results/gnuplot.hpp"
#include "experiments/results/gnuplot_axes.hpp"
#include "experiments/results/process.hpp"
#include "experiments/results/vtk/drawing.hpp"
#include "tests/experiments/results/temporary_folder.hpp"

namespace beamid::experiments::figure_test {
namespace {

// 25 s of a decaying oscillation of 4 Hz at 1000 samples per second, and its first second.
Figure time_histories() {
  const Eigen::VectorXd time = Eigen::VectorXd::LinSpaced(25000, 0.0, 24.999);
  const Eigen::VectorXd wave =
      ((time.array() * 8 * 3.14159).cos() * (-0.05 * time.array()).exp() * 12).matrix();
  return {"histories",
          {{"S(11.8)", {"time [s]"}, {"displacement [mm]"}, {{"measured", time, wave}}},
           {"first cycles",
            {"time [s]", false, std::pair{0.0, 1.0}},
            {"displacement [mm]"},
            {{"measured", time, wave}, {"reproduced", time, 0.9 * wave, CurveStyle::dashed}}}},
          2,
          1};
}

Figure every_style() {
  const Eigen::VectorXd x{{0.001, 0.002, 0.004}}, y{{600, 300, 150}};
  Figure figure{"styles",
                {{"",
                  {"ξ√M_{eq} [kg^{1/2}]", true},
                  {"error [%]", true},
                  {{"95 % band", x, {}, CurveStyle::band, 0.5 * y, 2 * y},
                   {"theory", x, y, CurveStyle::line, {}, {}, Colour::black},
                   {"EKF", x, y, CurveStyle::points, 0.9 * y, 1.1 * y},
                   {"UKF", x, y, CurveStyle::open_points},
                   {"mean", x, y, CurveStyle::dotted}}}}};
  return figure;
}

// Oracle: the first eight bytes of every PNG file (PNG specification, section 5.2), and the labels as text.
TEST(Figure, WritesDataScriptAndPictures) {
  TemporaryFolder folder;
  const Figure figure = every_style();
  write(figure, folder.path);
  EXPECT_EQ(folder.entries(), 4u);
  for (const std::string& file : files_of(figure))
    EXPECT_TRUE(std::filesystem::exists(folder.path / file)) << file;
  EXPECT_EQ(contents(folder.path / "styles.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
  const std::string svg = contents(folder.path / "styles.svg");
  for (const char* label : {"theory", "EKF", "95 % band", "ξ√M", "error [%]"})
    EXPECT_NE(svg.find(label), std::string::npos) << label;
  EXPECT_EQ(
      contents(folder.path / "styles.csv").find("95 % band | ξ√M_eq [kg^1/2],95 % band lower | error [%],"),
      0u);
}

// Oracle: bytes of a second run, and of the script run by hand.
TEST(Figure, IsTheSameWheneverDrawn) {
  TemporaryFolder first, second;
  write(time_histories(), first.path);
  write(time_histories(), second.path);
  for (const std::string& file : files_of(time_histories()))
    EXPECT_EQ(contents(first.path / file), contents(second.path / file)) << file;
  const std::string svg = contents(first.path / "histories.svg");
  std::filesystem::remove(first.path / "histories.svg");
  EXPECT_EQ(run_process({"gnuplot", "histories.gp"}, first.path).exit_code, 0);
  EXPECT_EQ(contents(first.path / "histories.svg"), svg);
  EXPECT_LT(svg.size(), 400'000u);
}

TEST(Figure, TakesLabelsLiterally) {
  EXPECT_EQ(gnuplot_text("massa1_test1-1"), R"("massa1\\_test1-1")");
  EXPECT_EQ(gnuplot_text("m/s^{2}"), "\"m/s^{2}\"");
  EXPECT_EQ(gnuplot_text("it's {a} `b` @c\nd"), R"("it's \\{a\\} \140b\140 \\\100c d")");
  EXPECT_EQ(gnuplot_text("open ^{brace"), R"("open \\^\\{brace")");
  EXPECT_EQ(gnuplot_text(std::string("A,x\\\0,`touch executed`", 22)),
            R"("A,x\\\134,\140touch executed\140")");

  TemporaryFolder folder;
  Figure figure = every_style();
  figure.panels[0].title = "`touch executed` '; system 'touch executed'\n!touch executed";
  figure.panels[0].curves[1].label = "\"`touch executed`\" \\";
  write(figure, folder.path);
  EXPECT_EQ(folder.entries(), 4u);
}

/// Expat's verdict; it asks nothing of the elements.
bool well_formed(const std::string& xml) {
  class Parser : public vtkXMLParser {
   public:
    static Parser* New() { return new Parser; }

   private:
    void StartElement(const char*, const char**) override {}
    void EndElement(const char*) override {}
  };
  return vtkNew<Parser>()->Parse(xml.c_str()) == 1;
}

// Oracle: the labels read back from the SVG, which an XML parser takes. Two apostrophes, or one in front,
// lost the whole folder of results; NUL in one label ran the next one as a shell command.
TEST(Figure, DrawsEveryLabelAndRunsNone) {
  TemporaryFolder folder;
  std::string printable;
  for (char c = ' '; c <= '~'; ++c) printable += c;
  const std::vector<std::pair<std::string, std::string>> labels{
      {"w''", "w''"},
      {"'tip'", "'tip'"},
      {printable, printable},
      {std::string("A,x\\\0", 5), "A,x\\"},
      {"`touch executed`", "`touch executed`"},
      {"$(touch executed) @x", "$(touch executed) @x"},
      {"^{a^{b}", "a^{b"},
      {"{}}{ %d #", "{}}{ %d #"},
      {"Beschleunigung [m/s\xb2]\x1b[2J", "Beschleunigung [m/s²][2J"},
      {"two\nlines", "two lines"},
      {"\\U+0007", "U+0007"}};
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(5, 0, 1);
  Figure figure{"labels", {{"'", {"'x'"}, {"y''"}, {}}}, 1, 1, 900, 900};
  for (const auto& [label, drawn] : labels) figure.panels[0].curves.push_back({label, x, x});
  write(figure, folder.path);
  EXPECT_EQ(folder.entries(), 4u);

  const std::string svg = contents(folder.path / "labels.svg");
  EXPECT_TRUE(well_formed(svg));
  std::string text;
  bool inside = false;
  for (const char c : svg) {
    if (!inside && c != '<') text += c;
    inside = c == '<' || (inside && c != '>');
  }
  text = unescaped(text);
  for (std::size_t at; (at = text.find("&#39;")) != std::string::npos;) text.replace(at, 5, "'");
  for (std::size_t at; (at = text.find("\u00a0")) != std::string::npos;) text.replace(at, 2, " ");
  for (const auto& [label, drawn] : labels) EXPECT_NE(text.find(drawn), std::string::npos) << drawn;
  // One line of names, whatever they hold: the script passes over one.
  const std::string csv = contents(folder.path / "labels.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
}

// What gnuplot cannot draw is no reason to lose it; one that hangs is not waited for.
TEST(Figure, IsNotDrawnWithoutAFault) {
  TemporaryFolder folder;
  Figure figure = every_style();
  write_data(figure, folder.path);
  std::ofstream(folder.path / "styles.gp") << "set output 'styles.svg'\nno command\n";
  try {
    draw(figure, folder.path);
    FAIL();
  } catch (const NotDrawn& failure) {
    EXPECT_FALSE(failure.hopeless());
    EXPECT_NE(std::string(failure.what()).find("figure 'styles' is not drawn: gnuplot failed (exit code 1)"),
              std::string::npos)
        << failure.what();
  }
  EXPECT_EQ(folder.entries(), 2u);
}

TEST(Process, IsKilledWhenItsTimeIsOver) {
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(run_process({"sleep", "30"}, "/tmp", 0.2).ended);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
  const ProcessResult in_time = run_process({"sh", "-c", "echo done; exit 3"}, "/tmp", 30);
  EXPECT_TRUE(in_time.ended);
  EXPECT_EQ(in_time.output, "done\n");
  EXPECT_EQ(in_time.exit_code, 3);
}

// A run that diverged is a result: its figure is drawn without the values it lacks.
TEST(Figure, DrawsCurvesWithoutFiniteValues) {
  TemporaryFolder folder;
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(10, 0, 1);
  const Eigen::VectorXd none = Eigen::VectorXd::Constant(10, std::numeric_limits<double>::quiet_NaN());
  Eigen::VectorXd some = x;
  some[4] = none[0];
  for (const bool logarithmic : {false, true}) {
    const Figure figure{
        "diverged",
        {{"", {"t [s]", logarithmic}, {"K [N/m]", logarithmic}, {{"none", x, none}}},
         {"", {"t [s]", logarithmic}, {"K [N/m]", logarithmic}, {{"none", x, none}, {"some", x, some}}},
         {"", {"t [s]"}, {"constant"}, {{"zero", x, 0 * x}}},
         {"", {"t [s]"}, {"empty"}, {}}},
        2,
        2};
    EXPECT_NO_THROW(write(figure, folder.path));
    EXPECT_NE(contents(folder.path / "diverged.svg").find("none (no values)"), std::string::npos);
    EXPECT_NE(contents(folder.path / "diverged.csv").find(",NaN"), std::string::npos);
  }
}

// Oracle: the definition. Each of 2000 intervals keeps its lowest and highest point.
TEST(Envelope, KeepsEndsExtremesAndGaps) {
  const Eigen::Index size = 100'000;
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(size, 0, 25);
  Eigen::VectorXd y = (x.array() * 25).sin();
  y[12'345] = 7;
  y[54'321] = -7;
  y[77'777] = std::numeric_limits<double>::quiet_NaN();
  const auto kept = envelope(x, y, false);
  const std::set<Eigen::Index> set(kept.begin(), kept.end());
  EXPECT_LE(kept.size(), 4003u);
  for (const Eigen::Index i :
       {Eigen::Index{0}, Eigen::Index{12'345}, Eigen::Index{54'321}, Eigen::Index{77'777}, size - 1})
    EXPECT_TRUE(set.count(i)) << i;
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_EQ(envelope(x.head(100), y.head(100), false).size(), 100u);
}

// On a logarithmic axis the first hundredth of the points is as wide as the rest and is thinned no more than
// it.
TEST(Envelope, FollowsALogarithmicAxis) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(100'000, 1, 100'000);
  const auto kept = envelope(x, x, true);
  EXPECT_EQ(std::count_if(kept.begin(), kept.end(), [](Eigen::Index i) { return i < 150; }), 150);
  EXPECT_LE(kept.size(), 4002u);
}

// Oracle: the files of the panel as it was. Of a million samples or ten, a page zooms into 200 000.
TEST(ThinnedPanel, WritesTheSameFiles) {
  constexpr Eigen::Index size = 1'000'000;
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(size, 0, 25);
  const Eigen::VectorXd y = (-0.1 * x.array()).exp() * (x.array() * 25).cos();
  Panel whole{"", {"time [s]"}, {"x [m]"}};
  whole.band("95 %", x, y.array() - 0.1, y.array() + 0.1).thin("measured", x, y).across(0, 25);
  Panel part = whole;
  part.across(3, 5).up(-1, 1);
  const auto files = [](const Panel& first, const Panel& second) {
    const TemporaryFolder folder;
    write_data({"long", {first, second}, 1, 2}, folder.path);
    return contents(folder.path / "long.csv") + contents(folder.path / "long.gp");
  };
  const Panel thin = thinned(whole), thin_part = thinned(part);
  EXPECT_EQ(files(thin, thin_part), files(whole, part));
  EXPECT_LT(thin.curves[1].x.size(), most_kept_points + 3);
  EXPECT_LT(thin_part.curves[1].x.size(), size / 12);
  part.y_axis.range.reset();  // its axis is as high as what is not shown
  EXPECT_EQ(thinned(part).curves[1].x.size(), size);
}

TEST(Figure, RefusesTheImpossible) {
  TemporaryFolder folder;
  Figure figure = every_style();
  figure.name = "../escape";
  EXPECT_THROW(write(figure, folder.path), std::invalid_argument);
  figure = every_style();
  figure.panels[0].curves[1].y = Eigen::VectorXd::Zero(2);
  try {
    write(figure, folder.path);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "figure 'styles', panel 1, curve 'theory': y has 2 values; expected 3 as in x");
  }
  figure = every_style();
  figure.rows = 0;
  EXPECT_THROW(write(figure, folder.path), std::invalid_argument);
  EXPECT_EQ(folder.entries(), 0u);
}

TEST(Figure, SaysThatGnuplotIsMissing) {
  TemporaryFolder folder;
  const std::string path = std::getenv("PATH") == nullptr ? "" : std::getenv("PATH");
  setenv("PATH", folder.path.c_str(), 1);
  std::string message;
  try {
    write(every_style(), folder.path);
  } catch (const std::runtime_error& error) {
    message = error.what();
  }
  setenv("PATH", path.c_str(), 1);
  EXPECT_NE(message.find("cannot start 'gnuplot': No such file or directory"), std::string::npos) << message;
}

TEST(Process, GivesOutputAndExitCode) {
  const ProcessResult result = run_process({"sh", "-c", "echo out; echo err >&2; exit 3"}, "/");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.output, "out\nerr\n");
  EXPECT_EQ(run_process({"pwd"}, "/").output, "/\n");
}

}  // namespace
}  // namespace beamid::experiments::figure_test
