// Input that means harm, or means well and is dangerous all the same: nothing is run, nothing commands the
// terminal, nothing hangs, and what was computed is kept. Oracles: the folder's listing, the bytes printed.
#include <gmock/gmock.h>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::hostile_input_test {
namespace {

using testing::HasSubstr, testing::Not;

bool has_control(const std::string& text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return (c >= 0 && c < ' ' && c != '\n') || c == 127; });
}

class Hostile : public testing::Test {
 protected:
  /// The record of tutorial 2, with another header.
  void write_record(const std::string& name, const std::string& header) {
    const std::string text = contents(source("docs/tutorials/02_identify_a_record/tip_acceleration.csv"));
    place_.write(name, header + text.substr(text.find('\n')));
  }

  Workplace place_;
};

// NUL reached gnuplot's script through a value of `vary`: gnuplot cut the line there, a backslash joined the
// next one, the quotes turned inside out, and a backtick was run by a shell.
TEST_F(Hostile, ExperimentFilesRunNoShellCommands) {
  std::string rig = contents(source("docs/tutorials/13_sweeps/rig.toml"));
  rig.replace(rig.find("[[sensors]]"), 11, "[[sensors]]\nname = \"tip\"");
  rig.replace(rig.find("vary = "), rig.find("seeds") - rig.find("vary = "),
              "vary = [\"damping.ratio=0.01,0.02\", \"sensors[1].name=A,x\\\\\\u0000,`touch " +
                  (place_.folder() / "OWNED").string() + "`\"]\n");
  rig.replace(rig.find("seeds = 200"), 11, "seeds = 2");
  place_.write("rig.toml", rig);
  const Outcome outcome = place_.run("sweep --config rig.toml --out swept");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("sweep.vary holds a control character"));
  EXPECT_THAT(place_.files(), testing::ElementsAre("rig.toml"));
}

// w'' is a second derivative, and 'tip' a name in quotes: both lost the whole folder.
TEST_F(Hostile, ApostrophesAndLatin1InNamesAreDrawn) {
  write_record("named.csv", "'t''s';'tip' w'' [m/s\xb2] \"`x`\"");
  std::string text = contents(place_.folder() / "named.csv");
  std::replace(text.begin() + static_cast<long>(text.find('\n')), text.end(), ',', ';');
  place_.write("named.csv", text);
  const Outcome outcome = place_.run(
      "modal named.csv --time 1 --column 2 --quantity acceleration --unit m/s2 --window 2 10 --out found");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(contents(place_.folder() / "found/reproduction.svg"), HasSubstr("w'' [m/s²]"));
  for (const std::string& file : place_.files()) {  // its byte in ISO 8859-1 is nowhere
    if (!file.starts_with("found/") || file.ends_with(".png")) continue;
    EXPECT_THAT(contents(place_.folder() / file), Not(HasSubstr("m/s\xb2"))) << file;
  }
}

TEST_F(Hostile, NothingCommandsTheTerminal) {
  const std::string escape = "\x1b[2J\x1b]0;x\x07";
  fs::copy(source("docs/tutorials/02_identify_a_record"), place_.folder(), fs::copy_options::recursive);
  place_.write("key.toml", "[beam]\n\"" + std::string("\\u001b[2J") + "\" = 1\n");
  place_.write("title.toml", "title = \"\\u001b[2J\"\n" + contents(place_.folder() / "cantilever.toml"));
  write_record("header.csv", "time_s,acceleration_tip" + escape + "_m_per_s2");
  place_.write(escape + ".csv", "1\n");
  for (const std::string words : {"validate key.toml", "modes --config title.toml", "inspect header.csv",
                                  "modal header.csv", "modal *0*x*.csv", "inspect $(printf '\\033[2J')",
                                  "'\x1b[2J'", "identify --config cantilever.toml --filter '\x1b[2J'"}) {
    const Outcome outcome = place_.run(words);
    EXPECT_FALSE(has_control(outcome.out)) << words << "\n" << outcome.out;
    EXPECT_FALSE(has_control(outcome.err)) << words << "\n" << outcome.err;
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 2) << words;
  }
}

TEST_F(Hostile, JsonReadBackIsRefusedInOneMessage) {
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  fs::create_directory(place_.folder() / "r");
  const auto refused = [&](const std::string& words) {
    const Outcome outcome = place_.run(words);
    EXPECT_EQ(outcome.code, 2) << words << outcome.err;
    EXPECT_THAT(outcome.err, Not(HasSubstr("json.exception")));
    return outcome.first_error_line();
  };
  place_.write("r/results.json", "{\"program\": \"beamid\", \"deep\": " + deep + "}");
  EXPECT_EQ(refused("report r --out page.html"),
            "r/results.json: JSON of more than 64 levels; expected the results of a beamid command");
  place_.write("r/results.json", "{\"program\": 5}");
  EXPECT_THAT(refused("report r --out page.html"), HasSubstr("not written by beamid"));
  place_.write("r/results.json", "{\"program\": \"beamid\", \"command\": 5}");
  EXPECT_THAT(refused("report r --out page.html"), HasSubstr("no text 'command'"));
  place_.write("r/manifest.json",
               "{\"program\": \"beamid sweep\", \"hash\": \"x\", \"shard\": " + deep + "}");
  EXPECT_THAT(refused("sweep --merge r --out all"), HasSubstr("JSON of more than 64 levels"));
  place_.write("r/manifest.json",
               "{\"program\": \"beamid sweep\", \"hash\": \"x\", \"shard\": {}, \"plan\": 3}");
  EXPECT_THAT(refused("sweep --merge r --out all"), HasSubstr("no plan of a sweep"));
}

TEST_F(Hostile, StatesReadBackAreRefusedInOneMessage) {
  fs::copy(source("docs/tutorials/02_identify_a_record"), place_.folder(), fs::copy_options::recursive);
  const nlohmann::ordered_json state{
      {"filter", "ekf"}, {"states", {"z1"}}, {"mean", nlohmann::json::array()}};
  place_.write("empty.json", state.dump());
  place_.write("deep.json", "{\"filter\": " + std::string(100000, '[') + std::string(100000, ']') + "}");
  place_.write("wrong.json", "{\"filter\": \"ekf\"}");
  for (const char* file : {"empty.json", "deep.json", "wrong.json"}) {
    const Outcome outcome = place_.run(std::string("stream --config cantilever.toml --resume ") + file);
    EXPECT_EQ(outcome.code, 2) << file;
    EXPECT_THAT(outcome.err, testing::StartsWith(file));
    EXPECT_THAT(outcome.err, Not(HasSubstr("json.exception")));
  }
}

// The experiment file itself was replaced by a state; a link FILE.part was followed.
TEST_F(Hostile, StatesReplaceNothingButStates) {
  fs::copy(source("docs/tutorials/02_identify_a_record"), place_.folder(), fs::copy_options::recursive);
  const std::string before = contents(place_.folder() / "cantilever.toml");
  const Outcome outcome = place_.run("stream --config cantilever.toml --save-state cantilever.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("cantilever.toml exists and is no state that --save-state wrote"));
  EXPECT_EQ(contents(place_.folder() / "cantilever.toml"), before);
}

// Without gnuplot a command with --out computed everything and kept nothing.
TEST_F(Hostile, ResultsAreKeptWhereNothingCanBeDrawn) {
  fs::copy(source("docs/tutorials/02_identify_a_record"), place_.folder(), fs::copy_options::recursive);
  const Outcome outcome = place_.run("identify --config cantilever.toml --out results", "PATH=/nowhere");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("figures are not drawn: gnuplot is missing"));
  const auto json = nlohmann::json::parse(contents(place_.folder() / "results/results.json"));
  EXPECT_THAT(json["warnings"].dump(), HasSubstr("cannot start 'gnuplot'"));
  std::size_t scripts = 0, listed = 0;
  for (const std::string& file : place_.files()) {
    if (!file.starts_with("results/")) continue;
    ++listed;
    scripts += file.ends_with(".gp");
    EXPECT_FALSE(file.ends_with(".svg") || file.ends_with(".png")) << file;
  }
  EXPECT_GT(scripts, 0u);
  EXPECT_EQ(json["files"].size(), listed);
  EXPECT_THAT(contents(place_.folder() / "results/report.html"), HasSubstr("is not drawn"));
  EXPECT_EQ(place_.run("identify --config cantilever.toml --out results --force").code, 0);  // drawn now
}

TEST_F(Hostile, PagesRunNoScriptsAndShowNoFiles) {
  fs::copy(source("docs/tutorials/02_identify_a_record"), place_.folder(), fs::copy_options::recursive);
  ASSERT_EQ(place_.run("modes --config cantilever.toml --out r").code, 0);
  std::string page = contents(place_.folder() / "r/report.html");
  EXPECT_THAT(page,
              HasSubstr("http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
                        "style-src 'unsafe-inline'; script-src 'sha256-"));
  ASSERT_EQ(place_.run("report r --out fine.html").code, 0);
  EXPECT_THAT(contents(place_.folder() / "fine.html"), HasSubstr("Content-Security-Policy"));
  for (const std::string harm :
       {"<iframe src=\"file:///etc/passwd\"></iframe>", "<script>for(;;);</script>",
        "<meta http-equiv=refresh content=\"0;file:///etc/passwd\">", "<!-- x -->"}) {
    std::string changed = page;
    changed.insert(changed.find("</h1>") + 5, harm);
    place_.write("r/report.html", changed);
    const Outcome outcome = place_.run("report r --out page.html");
    EXPECT_EQ(outcome.code, 2) << harm;
    EXPECT_THAT(outcome.err, HasSubstr("which beamid does not write")) << harm;
  }
}

// "#" ends a path in an address: the listing of the folder `work` was printed instead, with exit code 0.
// Oracle: a browser's stand-in, which notes the address it is asked for; its escapes by hand from RFC 3986.
TEST_F(Hostile, FolderNamesDoNotLeadTheBrowserAstray) {
  const fs::path odd = place_.folder() / "work#1 ?%41ξ";
  fs::create_directories(odd);
  fs::create_directory(place_.folder() / "bin");
  place_.write(
      "bin/chromium",
      "#!/bin/sh\nfor word; do case $word in\n--print-to-pdf=*) printf '%%PDF-1.4' > \"${word#*=}\";;\n"
      "file://*) printf %s \"$word\" > \"$NOTED\";;\nesac; done\n");
  fs::permissions(place_.folder() / "bin/chromium", fs::perms::owner_all);
  fs::copy(source("docs/tutorials/02_identify_a_record/cantilever.toml"), odd / "cantilever.toml");
  ASSERT_EQ(place_.run("modes --config 'work#1 ?%41ξ/cantilever.toml' --out 'work#1 ?%41ξ/r'").code, 0);
  place_.write("work#1 ?%41ξ/x.pdf.partial.html", "mine");
  const Outcome outcome = place_.run("report 'work#1 ?%41ξ/r' --pdf 'work#1 ?%41ξ/x.pdf'",
                                     "PATH=\"$PWD/bin:$PATH\" NOTED=\"$PWD/noted\"");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::string address = contents(place_.folder() / "noted");
  EXPECT_THAT(address, testing::StartsWith("file://" + place_.folder().string() +
                                           "/work%231%20%3F%2541%CE%BE/x.pdf."));
  EXPECT_EQ(contents(odd / "x.pdf.partial.html"), "mine");
}

/// Keys that took all memory, or all time, without a word which of them it was.
TEST_F(Hostile, NumbersOutOfAllProportionAreRefusedByName) {
  const std::string tutorial = contents(source("docs/tutorials/02_identify_a_record/cantilever.toml"));
  place_.write("tip_acceleration.csv",
               contents(source("docs/tutorials/02_identify_a_record/tip_acceleration.csv")));
  const auto error = [&](const std::string& from, const std::string& to, const std::string& words) {
    std::string text = tutorial;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos);
    place_.write("c.toml", text.replace(at, from.size(), to));
    const Outcome run = place_.run(words + " --config c.toml");
    EXPECT_EQ(run.code, 2) << words << " " << to;
    return run.first_error_line();
  };
  EXPECT_THAT(error("method = \"ekf\"", "method = \"particle\"\nparticles = 1e8", "identify"),
              HasSubstr("particles is 1e+08; expected a whole number of at least 2 and at most 1000000"));
  EXPECT_THAT(error("method = \"ekf\"", "method = \"enkf\"\nmembers = 1000000000", "identify"),
              HasSubstr("members is 1e+09; expected a whole number of at least 2 and at most 1000000"));
  EXPECT_THAT(error("length_m = 1.10", "length_m = 1100", "identifiability"),
              HasSubstr("samples at 1000 Hz; expected at most 200000. Lower simulation.sampling_rate_hz"));
  EXPECT_THAT(
      error("length_m = 1.10", "length_m = 1.10\nroot_rotational_stiffness_n_m_per_rad = 1e200", "modes"),
      HasSubstr("root_rotational_stiffness_n_m_per_rad is 1e+200; expected"));
  // Mode 1 came out at 100.8 Hz, "15 digits", where it is all but at rest.
  EXPECT_THAT(error("tip_mass_kg = 0.36049", "tip_mass_kg = 1e300", "modes"),
              HasSubstr("tip_mass_kg is 1e+300"));
  EXPECT_THAT(
      error("[filter]", "[[record.prepare]]\nstep = \"resample\"\nrate_hz = 1e300\n[filter]", "prepare"),
      HasSubstr("rate_hz is 1e+300"));
  EXPECT_THAT(error("file = \"tip_acceleration.csv\"", "file = \"/dev/zero\"", "identify"),
              HasSubstr("/dev/zero: a device; expected"));
}

TEST_F(Hostile, OverridesAndNamesAreReadToTheirEnd) {
  std::string rig = contents(source("docs/tutorials/13_sweeps/rig.toml"));
  place_.write("rig.toml", rig);
  const Outcome open = place_.run("sweep --config rig.toml --vary 'sensors[1.noise_m=1e-4,1e-3' --seeds 2");
  EXPECT_EQ(open.code, 2);
  EXPECT_THAT(open.err, HasSubstr("sensors[1"));
  rig.replace(rig.find("[[sensors]]"), 11, "[[sensors]]\nname = \"" + std::string(260, 'a') + "\"");
  place_.write("long.toml", rig);
  const Outcome name = place_.run("simulate --config long.toml --out out");
  EXPECT_EQ(name.code, 2);
  EXPECT_THAT(name.err, HasSubstr("expected at most 100 letters, as files are named after it"));
  const Outcome file = place_.run("inspect " + std::string(300, 'a'));
  EXPECT_EQ(file.code, 2);
  EXPECT_THAT(file.err, Not(HasSubstr("filesystem error")));
}

}  // namespace
}  // namespace beamid::apps::hostile_input_test
