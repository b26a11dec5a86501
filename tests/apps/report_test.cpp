// report.html beside every command's results, and beamid report. A browser, where one is installed, is the
// independent reader.
#include <gmock/gmock.h>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::report_test {
namespace {

using testing::HasSubstr;

class Report : public testing::Test {
 protected:
  Report() {
    fs::copy(source("docs/tutorials/02_identify_a_record"), place_.folder(), fs::copy_options::recursive);
  }

  Workplace place_;
};

TEST_F(Report, RepeatsTheCommandAndShowsEveryFigure) {
  ASSERT_EQ(place_.run("identify tip_acceleration.csv --config cantilever.toml --out results").code, 0);
  const std::string page = contents(place_.folder() / "results/report.html");
  EXPECT_THAT(
      page,
      HasSubstr(
          "<pre class=\"command\">beamid identify tip_acceleration.csv --config cantilever.toml</pre>"));
  EXPECT_THAT(page, HasSubstr("stiffness K [N/m]"));
  std::size_t pictures = 0, drawn = 0;
  for (std::size_t at = page.find("<img "); at != std::string::npos; at = page.find("<img ", at + 1))
    ++pictures;
  for (const std::string& file : place_.files()) drawn += file.ends_with(".svg");
  EXPECT_EQ(pictures, drawn);
}

TEST_F(Report, IsDrawnByABrowser) {
  if (std::system("command -v chromium > /dev/null") != 0) GTEST_SKIP() << "chromium is not installed";
  ASSERT_EQ(place_.run("identify --config cantilever.toml --out results").code, 0);
  const auto printed = [&](const std::string& page) {
    const fs::path pdf = place_.folder() / (page + ".pdf");
    const std::string line = "cd '" + place_.folder().string() +
                             "' && HOME=\"$PWD\" timeout 60 chromium --headless " +
                             "--no-sandbox --disable-gpu --print-to-pdf='" + pdf.string() + "' 'file://" +
                             (place_.folder() / page).string() + "' > /dev/null 2>&1";
    return std::system(line.c_str()) == 0 ? contents(pdf) : std::string();
  };
  const std::string whole = printed("results/report.html");
  ASSERT_TRUE(whole.starts_with("%PDF"));
  // The same page, its pictures broken: what they drew is missing from the PDF.
  std::string page = contents(place_.folder() / "results/report.html");
  const std::string picture = "data:image/svg+xml,";
  for (std::size_t at = page.find(picture); at != std::string::npos; at = page.find(picture, at + 1))
    page.replace(at + picture.size(), 8, "AAAAAAAA");
  place_.write("broken.html", page);
  const std::string broken = printed("broken.html");
  ASSERT_TRUE(broken.starts_with("%PDF"));
  EXPECT_GT(whole.size(), broken.size() + 20000);
}

TEST_F(Report, JoinsResultsAndComparesThem) {
  place_.run("identify --config cantilever.toml --out early --window 2 6");
  place_.run("identify --config cantilever.toml --out late --window 6 10");
  const Outcome outcome = place_.run("report early late --out both.html");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::string page = contents(place_.folder() / "both.html");
  for (const char* text : {"<h1>Side by side</h1>", "stiffness [N/m]",
                           "<th class=\"number\">in combined standard deviations</th>", "--window 2 6",
                           "--window 6 10", "early: Steel cantilever", "late: Steel cantilever"})
    EXPECT_THAT(page, HasSubstr(text));
  EXPECT_EQ(place_.run("report early --out both.html").code, 2);  // it exists
}

// Of a single run a parameter has its own name, whatever the reduction that it was found by is called.
TEST_F(Report, ComparesAParameterOfTwoReductions) {
  const std::string file = contents(place_.folder() / "cantilever.toml") + "[model]\nname = \"beam\"\n";
  for (const std::string reduction : {"rayleigh", "modal_truncation"}) {
    place_.write(reduction + ".toml", file + "[reduction]\nmethod = \"" + reduction + "\"\n");
    ASSERT_EQ(place_.run("identify --config " + reduction + ".toml --out " + reduction).code, 0);
  }
  ASSERT_EQ(place_.run("report rayleigh modal_truncation --out both.html").code, 0);
  const std::string page = contents(place_.folder() / "both.html");
  const std::size_t parameters = page.find("Parameters, with 95 % intervals");
  EXPECT_LT(page.find("<td>reduction.method</td>"), parameters);  // what differs comes first
  EXPECT_NE(page.find("<td>bending stiffness [N m²]</td>", parameters), std::string::npos);
}

TEST_F(Report, SaysHowTheRunsWereMadeAndWhatDiffers) {
  std::string other = contents(place_.folder() / "cantilever.toml");
  const std::size_t at = other.find("\"ekf\"");
  ASSERT_NE(at, std::string::npos);
  place_.write("other.toml", other.replace(at, 5, "\"ukf\""));
  place_.run("identify --config cantilever.toml --out first");
  place_.run("identify --config other.toml --out second");
  ASSERT_EQ(place_.run("report first second --out both.html").code, 0);
  const std::string page = contents(place_.folder() / "both.html");
  // What differs comes first.
  const std::size_t side = page.find("<h1>Side by side</h1>"),
                    differs = page.find("<td>experiment.filter.method</td>", side);
  EXPECT_LT(differs, page.find("Parameters, with 95 % intervals"));
  const std::size_t begin = page.find("<h1>Methods and versions</h1>"), end = page.find("</section>", begin);
  ASSERT_NE(begin, std::string::npos);
  const std::string part = page.substr(begin, end - begin);
  for (const char* text : {"<pre>beamid identify --config cantilever.toml</pre>",
                           "<pre>beamid identify --config other.toml</pre>", "<th>first</th><th>second</th>",
                           "<td>ekf</td><td>ukf</td>", "<td>beamid identify</td><td>beamid identify</td>",
                           "<td>Eigen</td>", "<td>compiler</td>"})
    EXPECT_THAT(part, HasSubstr(text));
  EXPECT_EQ(part.find("length_m"), std::string::npos);  // the same in both
}

// Oracle: chromium's own PDF, whose text it compresses; sizes and the first bytes tell that pages are there.
TEST_F(Report, IsPrintedToPdf) {
  if (std::system("command -v chromium > /dev/null || command -v google-chrome > /dev/null") != 0)
    GTEST_SKIP() << "neither chromium nor google-chrome is installed";
  place_.run("identify --config cantilever.toml --out one");
  const Outcome outcome = place_.run("report one --pdf one.pdf");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "Printed to one.pdf\n");
  const std::string pdf = contents(place_.folder() / "one.pdf");
  EXPECT_TRUE(pdf.starts_with("%PDF"));
  EXPECT_GT(pdf.size(), 30000u);  // the figures are in it
  for (const std::string& file : place_.files()) EXPECT_EQ(file.find("partial"), std::string::npos) << file;
  EXPECT_EQ(place_.run("report one --pdf one.pdf").code, 2);  // it exists
}

// Oracle: the head of a PNG file: its size stands behind the first 16 bytes.
TEST_F(Report, IsAPictureOfItsBeginning) {
  if (std::system("command -v chromium > /dev/null || command -v google-chrome > /dev/null") != 0)
    GTEST_SKIP() << "neither chromium nor google-chrome is installed";
  place_.run("identify --config cantilever.toml --out one");
  const Outcome outcome = place_.run("report one --png one.png");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "Printed to one.png\n");
  const std::string png = contents(place_.folder() / "one.png");
  ASSERT_GT(png.size(), 30000u);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  const auto number = [&](std::size_t at) {
    return static_cast<unsigned char>(png[at + 2]) * 256 + static_cast<unsigned char>(png[at + 3]);
  };
  EXPECT_EQ(number(16), 960);
  EXPECT_EQ(number(20), 928);
  for (const std::string& file : place_.files()) EXPECT_EQ(file.find("partial"), std::string::npos) << file;
  EXPECT_EQ(place_.run("report one --png one.jpg").code, 2);
}

TEST_F(Report, SaysWhereNothingPrints) {
  place_.run("identify --config cantilever.toml --out one");
  const Outcome outcome = place_.run("report one --pdf one.pdf", "PATH=/nowhere");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("neither chromium nor google-chrome is installed"));
  EXPECT_FALSE(fs::exists(place_.folder() / "one.pdf"));
}

TEST_F(Report, RefusesWhatBeamidDidNotWrite) {
  place_.write("results.json", "{\"program\": \"other\"}");
  EXPECT_EQ(place_.run("report . --out page.html").first_error_line(),
            "./results.json: not written by beamid; expected the results of one of its commands");
  EXPECT_EQ(place_.run("report --out page.html").code, 2);
}

}  // namespace
}  // namespace beamid::apps::report_test
