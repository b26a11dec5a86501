// The mean of the record, or of a part of it where nothing moves, subtracted.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "experiments/record/prepare/channel_step.hpp"
#include "experiments/signal/onsets.hpp"

namespace beamid::experiments {
namespace {

/// Of the samples that are not missing.
double mean_of(const Eigen::ArrayXd& samples) {
  const auto there = samples.isFinite();
  return there.select(samples, 0).sum() / static_cast<double>(there.count());
}

class Offset final : public ChannelStep {
 public:
  explicit Offset(const filters::Options& options)
      : ChannelStep(options),
        of_(word_option(options, "of", {"all", "quiet", "interval"})),
        from_(options.number("from_s")),
        to_(options.number("to_s")) {}

  static std::vector<filters::OptionSpec> options() {
    return {{"of", std::string("all"), "",
             "mean of all, of the quiet part before the first event of each channel, or of an interval"},
            {"from_s", 0.0, "s", "where the interval begins"},
            {"to_s", 0.0, "s", "where it ends"},
            channels_option()};
  }

  void check() const override {
    if (of_ == "interval" && !(from_ < to_))
      throw std::invalid_argument(
          fmt::format("interval {:g} to {:g} s; expected from_s below to_s", from_, to_));
    if (of_ != "interval" && (from_ != 0 || to_ != 0))
      throw std::invalid_argument("from_s and to_s without use; expected of = \"interval\" beside them");
  }

  std::string apply(Record& record) const override {
    std::string text;
    for (const Eigen::Index row : rows(record)) {
      const double mean = offset(record, row);
      record.samples.row(row).array() -= mean;
      text += fmt::format("{}{:.4g} {} from {}", text.empty() ? "" : ", ", mean,
                          si_unit(record.channels[row].quantity), words(record, {row}));
    }
    return "Offset subtracted, the mean of " +
           (of_ == "all"     ? std::string("the whole record")
            : of_ == "quiet" ? std::string("the quiet part before the first event")
                             : fmt::format("{:g} to {:g} s", from_, to_)) +
           ": " + text + ".";
  }

  bool exact() const override { return false; }
  bool takes_any_record() const override { return of_ != "quiet"; }

 private:
  double offset(const Record& record, Eigen::Index row) const {
    if (of_ == "all") return mean_of(record.samples.row(row));
    if (of_ == "interval") return mean_of(record.window(from_, to_).samples.row(row));
    const Onsets found = find_onsets(record.samples.row(row).transpose(), even_interval(record));
    if (found.samples.empty())
      throw std::invalid_argument("no event in " + words(record, {row}) +
                                  R"(, hence no quiet part before it; expected of = "all" or "interval")");
    return found.baseline;
  }

  std::string of_;
  double from_, to_;
};

const bool offset_registered =
    step_registry().add({"offset",
                         "the mean of all, of the quiet part or of an interval, subtracted",
                         "",
                         Offset::options(),
                         {},
                         [](const filters::Options& o) { return std::make_unique<Offset>(o); }});

}  // namespace
}  // namespace beamid::experiments
