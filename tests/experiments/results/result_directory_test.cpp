#include "experiments/results/result_directory.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

#include "tests/experiments/results/temporary_folder.hpp"

namespace beamid::experiments::result_directory_test {
namespace {

namespace fs = std::filesystem;

// Earlier results as beamid leaves them.
void make_results(const fs::path& folder, const std::string& files = R"("old.csv", "results.json")") {
  fs::create_directories(folder);
  std::ofstream(folder / "results.json") << R"({"program": "beamid", "files": [)" << files << "]}";
  std::ofstream(folder / "old.csv") << "old\n";
}

std::string refusal(const fs::path& folder, bool force) {
  try {
    ResultDirectory directory(folder, force);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ResultDirectory, AppearsWithItsFilesOnCommit) {
  TemporaryFolder temporary;
  const fs::path out = temporary.path / "deep" / "out";
  ResultDirectory directory(out, false);
  directory.write("a.txt", "text");
  EXPECT_FALSE(fs::exists(out));
  directory.commit();
  EXPECT_EQ(contents(out / "a.txt"), "text");
  EXPECT_EQ(std::distance(fs::directory_iterator(out.parent_path()), {}), 1);
}

TEST(ResultDirectory, LeavesNothingWithoutCommit) {
  TemporaryFolder temporary;
  try {
    ResultDirectory directory(temporary.path / "deep" / "out", false);
    directory.write("a.txt", "text");
    throw std::runtime_error("the computation failed");
  } catch (const std::runtime_error&) {
  }
  EXPECT_EQ(temporary.entries(), 0u);
}

// A process that has ended without a commit, one that has not, and a folder of another name.
TEST(ResultDirectory, ClearsWhatEndedProcessesLeft) {
  TemporaryFolder temporary;
  const pid_t ended = fork();
  if (ended == 0) _exit(0);
  waitpid(ended, nullptr, 0);
  const std::string prefix = ".out.partial-";
  const fs::path abandoned = temporary.path / (prefix + std::to_string(ended)),
                 of_another = temporary.path / (prefix + std::to_string(getppid())),
                 of_someone = temporary.path / (prefix + "notes");
  for (const fs::path& folder : {abandoned, of_another, of_someone}) fs::create_directory(folder);
  std::ofstream(abandoned / "a.txt") << "half";
  ResultDirectory directory(temporary.path / "out", false);
  directory.write("a.txt", "text");
  directory.commit();
  EXPECT_FALSE(fs::exists(abandoned));
  EXPECT_TRUE(fs::exists(of_another) && fs::exists(of_someone));
}

TEST(ResultDirectory, TakesThePlaceOfAnEmptyFolder) {
  TemporaryFolder temporary;
  fs::create_directory(temporary.path / "out");
  ResultDirectory directory(temporary.path / "out/", false);
  directory.write("a.txt", "text");
  directory.commit();
  EXPECT_EQ(contents(temporary.path / "out/a.txt"), "text");
  EXPECT_EQ(temporary.entries(), 1u);
}

TEST(ResultDirectory, RefusesAFolderWithContents) {
  TemporaryFolder temporary;
  make_results(temporary.path / "out");
  const std::string message = refusal(temporary.path / "out", false);
  EXPECT_NE(message.find("out' is not empty"), std::string::npos) << message;
  EXPECT_NE(message.find("--force"), std::string::npos) << message;
}

TEST(ResultDirectory, ForceReplacesEarlierResultsAsAWhole) {
  TemporaryFolder temporary;
  const fs::path out = temporary.path / "out";
  make_results(out);
  {
    ResultDirectory directory(out, true);
    directory.write("new.csv", "new\n");
    EXPECT_EQ(contents(out / "old.csv"), "old\n");  // until the commit
    directory.commit();
  }
  EXPECT_EQ(contents(out / "new.csv"), "new\n");
  EXPECT_FALSE(fs::exists(out / "old.csv"));
  EXPECT_EQ(temporary.entries(), 1u);
}

TEST(ResultDirectory, ForceKeepsEarlierResultsWhenTheNewOnesFail) {
  TemporaryFolder temporary;
  make_results(temporary.path / "out");
  {
    ResultDirectory directory(temporary.path / "out", true);
    directory.write("new.csv", "new\n");
  }
  EXPECT_EQ(contents(temporary.path / "out/old.csv"), "old\n");
  EXPECT_EQ(temporary.entries(), 1u);
}

TEST(ResultDirectory, ForceDeletesNothingThatBeamidDidNotWrite) {
  TemporaryFolder temporary;
  const fs::path foreign = temporary.path / "foreign";
  fs::create_directory(foreign);
  std::ofstream(foreign / "results.json") << R"({"program": "other"})";
  EXPECT_NE(refusal(foreign, true).find("no results.json of beamid"), std::string::npos);

  const fs::path mixed = temporary.path / "mixed";
  make_results(mixed);
  std::ofstream(mixed / "thesis.tex") << "years of work";
  EXPECT_NE(refusal(mixed, true).find("'thesis.tex'"), std::string::npos);

  // A folder is never one of the results, whatever the list says.
  const fs::path nested = temporary.path / "nested";
  make_results(nested, R"("old.csv", "results.json", "data")");
  fs::create_directory(nested / "data");
  EXPECT_NE(refusal(nested, true).find("'data'"), std::string::npos);
  EXPECT_TRUE(fs::exists(mixed / "thesis.tex"));
}

TEST(ResultDirectory, RefusesWhatArrivedWhileItWasComputing) {
  TemporaryFolder temporary;
  const fs::path out = temporary.path / "out";
  {
    ResultDirectory directory(out, false);
    directory.write("new.csv", "new\n");
    fs::create_directory(out);
    std::ofstream(out / "thesis.tex") << "years of work";
    EXPECT_THROW(directory.commit(), std::invalid_argument);
  }
  EXPECT_EQ(contents(out / "thesis.tex"), "years of work");
  EXPECT_EQ(temporary.entries(), 1u);
}

TEST(ResultDirectory, RefusesFilesAndTheCurrentFolder) {
  TemporaryFolder temporary;
  std::ofstream(temporary.path / "file") << "text";
  EXPECT_NE(refusal(temporary.path / "file", true).find("is a file"), std::string::npos);
  EXPECT_NE(refusal(temporary.path / "file/out", true).find("is a file"), std::string::npos);
  EXPECT_NE(refusal(".", true).find("current folder"), std::string::npos);
  EXPECT_NE(refusal("/", true).find("current folder"), std::string::npos);
}

TEST(ResultDirectory, SaysWhyAFileCannotBeWritten) {
  TemporaryFolder temporary;
  ResultDirectory directory(temporary.path / "out", false);
  try {
    directory.write("missing/a.txt", "text");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("a.txt': No such file or directory"), std::string::npos)
        << error.what();
  }
}

TEST(ResultDirectory, NoticesAFullDisk) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  TemporaryFolder temporary;
  ResultDirectory directory(temporary.path / "out", false);
  fs::create_symlink("/dev/full", directory.path() / "a.txt");
  try {
    directory.write("a.txt", "text");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace beamid::experiments::result_directory_test
