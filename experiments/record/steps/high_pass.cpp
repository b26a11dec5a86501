// Butterworth high-pass [butterworth1930], against offset and drift.
#include <fmt/format.h>

#include "experiments/record/prepare/channel_step.hpp"
#include "experiments/signal/butterworth.hpp"

namespace beamid::experiments {
namespace {

class HighPass final : public FilterStep {
 public:
  explicit HighPass(const filters::Options& options)
      : FilterStep(options),
        corner_(options.number("corner_hz")),
        order_(whole_option(options, "order", 1, 8)) {}

  static std::vector<filters::OptionSpec> options() {
    return with_common_options({{"corner_hz", 0.0, "Hz", "where half of the power passes; must be given"},
                                {"order", 2.0, "", "1 to 8"}});
  }

  void check() const override { need("corner_hz", corner_); }

 protected:
  CascadedFilter filter(double interval) const override {
    return butterworth_high_pass(order_, corner_, interval);
  }
  std::string name() const override {
    return fmt::format("Butterworth high-pass of order {} at {:g} Hz", order_, corner_);
  }

 private:
  double corner_;
  int order_;
};

const bool high_pass_registered =
    step_registry().add({"high_pass",
                         "Butterworth high-pass, against offset and drift",
                         "[butterworth1930]",
                         HighPass::options(),
                         {},
                         [](const filters::Options& o) { return std::make_unique<HighPass>(o); }});

}  // namespace
}  // namespace beamid::experiments
