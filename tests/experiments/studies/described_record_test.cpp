// The experiment file that inspect --write makes. Oracle: the record as it is read without it.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "experiments/config/readers.hpp"
#include "experiments/record/read_record.hpp"
#include "experiments/studies/inspect/inspection_report.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::described_record_test {
namespace {

using testing::HasSubstr;

TEST(DescribedRecord, IsReadAgainAsItWas) {
  const auto rows = [](const std::string& header, auto row) {
    std::string text = header;
    for (int k = 0; k < 40; ++k) text += row(k, 4.0 * std::cos(0.7 * k)) + "\n";
    return text;
  };
  RecordFormat usual, stated;
  usual.irregular = stated.irregular = true;
  stated.sampling_rate = 200.0;
  for (const auto& [text, format, expected] :
       {std::tuple{
            rows("Time (ms);Acc [g]\n", [](int k, double y) { return fmt::format("{};{:.4f}", 5 * k, y); }),
            usual, "unit = \"g\""},
        {rows("", [](int k, double y) { return fmt::format("{:.3f} {:.4f}", 0.005 * k, y); }), usual,
         "column = 2"},
        {rows("Sample,ax,ay\n", [](int k, double y) { return fmt::format("{},{:.4f},0", k, y); }), stated,
         "sampling_rate_hz = 200"},
        {rows("Date,tip (mg)\n",
              [](int k, double y) { return fmt::format("26.11.2026 10:00:00.{:03},{:.4f}", 5 * k, y); }),
         usual, "file = "},
        {rows("t,a\n",
              [](int k, double y) {
                return fmt::format("{:.3f},{}", 0.005 * k, k == 7 ? "NaN" : fmt::format("{:.4f}", y));
              }),
         usual, "malformed = \"missing\""}}) {
    const TemporaryFile file("record.txt", text);
    const std::string description = described_record(file.path(), format, file.path().parent_path());
    EXPECT_THAT(description, HasSubstr(expected));
    const std::filesystem::path config = file.path().parent_path() / "mine.toml";
    std::ofstream(config) << description;
    const RecordSection section = read_record_section(config);
    EXPECT_EQ(section.file, "record.txt");
    const Record before = read_record(file.path(), format), after = read_record(file.path(), section.format);
    ASSERT_EQ(after.samples.rows(), before.samples.rows());
    EXPECT_TRUE(after.time.isApprox(before.time, 1e-12));
    for (Eigen::Index k = 0; k < before.size(); ++k)
      EXPECT_TRUE(after.samples(0, k) == before.samples(0, k) ||
                  (std::isnan(after.samples(0, k)) && std::isnan(before.samples(0, k))))
          << description << k;
  }
}

}  // namespace
}  // namespace beamid::experiments::described_record_test
