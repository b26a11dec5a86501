// Every n-th sample, behind a symmetric low-pass against aliasing [kaiser1974].
#include <fmt/format.h>

#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/signal/decimation.hpp"

namespace beamid::experiments {
namespace {

class Decimate final : public PreparationStep {
 public:
  explicit Decimate(const filters::Options& options) : factor_(whole_option(options, "factor", 2, 1000)) {}

  static std::vector<filters::OptionSpec> options() {
    return {{"factor", 2.0, "", "one sample in so many is kept, 2 to 1000"}};
  }

  std::string apply(Record& record) const override {
    const double interval = even_interval(record);
    Record fewer = record;
    fewer.samples = decimate_channels(record.samples, factor_);
    fewer.time = record.time(Eigen::seqN(5 * factor_, fewer.samples.cols(), factor_));
    const double rate = 1 / (factor_ * interval);
    record = std::move(fewer);
    return fmt::format(
        "Decimated by {} to {:.6g} Hz: flat to {:.4g} Hz, stopped above {:.4g} Hz; {:.3g} s removed at each "
        "end.",
        factor_, rate, 0.3 * rate, 0.7 * rate, 5 * factor_ * interval);
  }

  void follow(std::vector<FollowedChannel>& channels, std::complex<double> rate,
              double interval) const override {
    const auto kernel = decimate(Eigen::VectorXd::Zero(10 * factor_ + 1), interval, factor_);
    for (FollowedChannel& followed : channels) followed.factor *= kernel.response(rate);
  }

  bool exact() const override { return true; }

 private:
  int factor_;
};

const bool decimate_registered =
    step_registry().add({"decimate",
                         "fewer samples, behind a symmetric low-pass against aliasing",
                         "[kaiser1974]",
                         Decimate::options(),
                         {},
                         [](const filters::Options& o) { return std::make_unique<Decimate>(o); }});

}  // namespace
}  // namespace beamid::experiments
