// Butterworth band-pass [butterworth1930]: a high-pass and a low-pass in series.
#include <fmt/format.h>

#include <stdexcept>

#include "experiments/record/prepare/channel_step.hpp"
#include "experiments/signal/butterworth.hpp"

namespace beamid::experiments {
namespace {

class BandPass final : public FilterStep {
 public:
  explicit BandPass(const filters::Options& options)
      : FilterStep(options),
        lower_(options.number("lower_hz")),
        upper_(options.number("upper_hz")),
        order_(whole_option(options, "order", 1, 8)) {}

  static std::vector<filters::OptionSpec> options() {
    return with_common_options({{"lower_hz", 0.0, "Hz", "corner of the high-pass; must be given"},
                                {"upper_hz", 0.0, "Hz", "corner of the low-pass; must be given"},
                                {"order", 2.0, "", "of each of the two, 1 to 8"}});
  }

  void check() const override {
    need("lower_hz", lower_);
    need("upper_hz", upper_);
    if (!(lower_ < upper_))
      throw std::invalid_argument(
          fmt::format("band from {:g} to {:g} Hz; expected lower_hz below upper_hz", lower_, upper_));
  }

 protected:
  CascadedFilter filter(double interval) const override {
    return cascade(butterworth_high_pass(order_, lower_, interval),
                   butterworth_low_pass(order_, upper_, interval));
  }
  std::string name() const override {
    return fmt::format("Butterworth band-pass of order {} from {:g} to {:g} Hz", order_, lower_, upper_);
  }

 private:
  double lower_, upper_;
  int order_;
};

const bool band_pass_registered =
    step_registry().add({"band_pass",
                         "Butterworth band-pass: a high-pass and a low-pass in series",
                         "[butterworth1930]",
                         BandPass::options(),
                         {},
                         [](const filters::Options& o) { return std::make_unique<BandPass>(o); }});

}  // namespace
}  // namespace beamid::experiments
