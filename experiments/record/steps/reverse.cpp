// The other direction: of a sensor that points against the force, or a force that pushes against the axis.
#include "experiments/record/prepare/channel_step.hpp"

namespace beamid::experiments {
namespace {

class Reverse final : public ChannelStep {
 public:
  explicit Reverse(const filters::Options& options) : ChannelStep(options) {}

  static std::vector<filters::OptionSpec> options() { return {channels_option()}; }

  std::string apply(Record& record) const override {
    const std::vector<Eigen::Index> reversed = rows(record);
    for (const Eigen::Index row : reversed) record.samples.row(row) *= -1;
    return "Sign changed: " + words(record, reversed) + ".";
  }

  bool exact() const override { return true; }
  bool takes_any_record() const override { return true; }

 private:
  std::complex<double> factor(std::complex<double>, double) const override { return -1; }
};

const bool reverse_registered =
    step_registry().add({"reverse",
                         "the sign changed, where a sensor points against the force",
                         "",
                         Reverse::options(),
                         {},
                         [](const filters::Options& o) { return std::make_unique<Reverse>(o); }});

}  // namespace
}  // namespace beamid::experiments
