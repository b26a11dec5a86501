// Butterworth low-pass [butterworth1930], against higher modes and noise.
#include <fmt/format.h>

#include "experiments/record/prepare/channel_step.hpp"
#include "experiments/signal/butterworth.hpp"

namespace beamid::experiments {
namespace {

class LowPass final : public FilterStep {
 public:
  explicit LowPass(const filters::Options& options)
      : FilterStep(options),
        corner_(options.number("corner_hz")),
        order_(whole_option(options, "order", 1, 8)) {}

  static std::vector<filters::OptionSpec> options() {
    return with_common_options({{"corner_hz", 0.0, "Hz", "where half of the power passes; must be given"},
                                {"order", 4.0, "", "1 to 8"}});
  }

  void check() const override { need("corner_hz", corner_); }

 protected:
  CascadedFilter filter(double interval) const override {
    return butterworth_low_pass(order_, corner_, interval);
  }
  std::string name() const override {
    return fmt::format("Butterworth low-pass of order {} at {:g} Hz", order_, corner_);
  }

 private:
  double corner_;
  int order_;
};

const bool low_pass_registered =
    step_registry().add({"low_pass",
                         "Butterworth low-pass, against higher modes and noise",
                         "[butterworth1930]",
                         LowPass::options(),
                         {},
                         [](const filters::Options& o) { return std::make_unique<LowPass>(o); }});

}  // namespace
}  // namespace beamid::experiments
