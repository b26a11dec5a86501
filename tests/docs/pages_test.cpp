// README, guides and tutorials, read from top to bottom: every command runs as printed, from the folder that
// the page is in by then, beginning at the repository's root, and prints what the page shows.
#include <gmock/gmock.h>

#include <iostream>

#include "tests/docs/page.hpp"
#include "tests/docs/printed_output.hpp"
#include "tests/docs/shell.hpp"

namespace beamid::docs::pages_test {
namespace {

std::vector<std::string> pages() {
  std::vector<std::string> found{"README.md"};
  for (const auto& entry : fs::directory_iterator(source("docs/tutorials")))
    if (entry.is_directory())
      found.push_back("docs/tutorials/" + entry.path().filename().string() + "/README.md");
  for (const auto& entry : fs::directory_iterator(source("docs/guides")))
    if (entry.path().extension() == ".md") found.push_back("docs/guides/" + entry.path().filename().string());
  std::sort(found.begin() + 1, found.end());
  return found;
}

/// Pages are the program, to the printed digit; those whose last digit a processor decides are named with the
/// reason. Tried with and without AVX, AVX2, FMA and AVX-512 of the C library (GLIBC_TUNABLES).
double allowed_digits(const std::string& page) {
  if (page.find("25_shake_table") != std::string::npos)
    return 2;  // a search over 12,000 samples ends where rounding lets it: 2e-8 of the estimate
  return 0;
}

bool is_set(const char* variable) {
  return std::getenv(variable) != nullptr;
}

class Pages : public testing::TestWithParam<std::string> {
 protected:
  /// Runs what stands in the page; false where it was left out.
  bool run(const Block& block) {
    const bool data_missing = std::exchange(missing_data_, false);
    if (data_missing)
      std::cout << "[ LEFT OUT ] " << GetParam() << ":" << block.line
                << ": the measured record that it needs is not here\n";
    if (block.skipped || data_missing || (block.is_long && !is_set("BEAMID_LONG_PAGES"))) return false;
    std::string lines = "set -e\n";
    for (const std::string& line : block.text) lines += line + "\n";
    const Outcome outcome =
        shell_.run("trap 'pwd >\"" + (shell_.root() / ".folder").string() + "\"' EXIT\n" + lines, folder_);
    EXPECT_EQ(outcome.code, block.exit_code)
        << GetParam() << ":" << block.line << ": " << lines << outcome.err;
    folder_ = fs::relative(lines_of(contents(shell_.root() / ".folder")).at(0), shell_.root());
    outputs_.push_back(lines_of(outcome.out + outcome.err));
    return true;
  }

  /// A measured record for the next command.
  void provide(const Block& block) {
    std::istringstream words(block.text.at(0));
    std::string record, folder;
    words >> record >> folder;
    const fs::path file = source("../shared/data") / record,
                   copy = shell_.root() / "docs/tutorials" / folder / file.filename();
    missing_data_ = missing_data_ || !fs::exists(file);
    if (fs::exists(file) && !fs::exists(copy)) fs::copy(file, copy);
  }

  void compare(const Block& block) {
    for (const Fragment& fragment : fragments(block.text, block.line)) {
      const Place place = best_place(fragment.text, outputs_);
      const std::string where = fmt::format("{}:{}: ", GetParam(), fragment.line);
      if (place.same == 0) {
        ADD_FAILURE() << where << "no command above prints any line of this";
        continue;
      }
      const std::vector<std::string>& output = outputs_[place.output];
      const std::string differences = disagreement(fragment, output, place.line, allowed_digits(GetParam()));
      if (differences.empty()) continue;
      if (updating() && 2 * place.same >= fragment.text.size()) {
        for (std::size_t i = 0; i < fragment.text.size() && place.line + i < output.size(); ++i)
          lines_.at(std::size_t(fragment.line) - 1 + i) = output[place.line + i];
        changed_ = true;
      } else {
        ADD_FAILURE() << where << "not what is printed\n" << differences;
      }
    }
  }

  /// Writes the page where lines of its outputs have been replaced.
  void save() const {
    if (!changed_) return;
    std::ofstream page(source(GetParam()));
    for (const std::string& line : lines_) page << line << "\n";
  }

  std::vector<std::string> lines_ = lines_of(contents(source(GetParam())));
  bool changed_ = false;
  Shell shell_;
  std::string folder_ = ".";
  std::vector<std::vector<std::string>> outputs_;
  bool missing_data_ = false;
};

TEST_P(Pages, PrintWhatTheirCommandsPrint) {
  bool ran = true;  // the command before
  const Page page(lines_);
  for (const Block& block : page.blocks())
    if (block.kind == Block::Kind::data)
      provide(block);
    else if (block.kind == Block::Kind::command)
      ran = run(block);
    else if (ran && !block.skipped)
      compare(block);
  save();
}

INSTANTIATE_TEST_SUITE_P(Documentation, Pages, testing::ValuesIn(pages()), [](const auto& tested) {
  const fs::path page(tested.param);
  const std::string folder = page.parent_path().filename().string();
  if (folder.empty()) return std::string("README");
  return folder == "guides" ? "Guide_" + page.stem().string() : "Tutorial" + folder;
});

}  // namespace
}  // namespace beamid::docs::pages_test
