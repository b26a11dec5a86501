#include "experiments/record/prepare/filter_step.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace beamid::experiments {
FilterStep::FilterStep(const filters::Options& options)
    : ChannelStep(options),
      zero_phase_(options.flag("zero_phase")),
      trim_(options.flag("trim")),
      start_(word_option(options, "start", {"steady", "rest"}) == "rest" ? FilterStart::rest
                                                                         : FilterStart::steady) {}

std::vector<filters::OptionSpec> FilterStep::with_common_options(std::vector<filters::OptionSpec> own) {
  own.push_back({"zero_phase", false, "", "forwards and backwards: no phase shift, the square of the gain"});
  own.push_back({"start", std::string("steady"), "",
                 "causal: before the record lies its first sample (steady) or nothing (rest)"});
  own.push_back({"trim", false, "", "cut off the ends, until transients are down to 1e-3"});
  own.push_back(channels_option());
  return own;
}

void FilterStep::need(const char* option, double value) {
  if (!(value > 0))
    throw std::invalid_argument(fmt::format("{} is {}; expected a corner above 0 Hz", option,
                                            value == 0 ? "missing" : fmt::format("{:g}", value)));
}

double FilterStep::settling(double interval) const {
  return static_cast<double>(settling_samples(filter(interval))) * interval;
}

Transient FilterStep::transient(double interval) const {
  if (trim_) return {};
  const double lasting = settling(interval);
  return {lasting, zero_phase_ ? lasting : 0};
}

std::complex<double> FilterStep::factor(std::complex<double> rate, double interval) const {
  return zero_phase_ ? zero_phase_response(filter(interval), rate) : response(filter(interval), rate);
}

std::string FilterStep::apply(Record& record) const {
  const double interval = even_interval(record);
  const CascadedFilter sections = filter(interval);
  const std::vector<Eigen::Index> chosen = rows(record);
  for (const Eigen::Index row : chosen) {
    const Eigen::VectorXd signal = record.samples.row(row).transpose();
    record.samples.row(row) =
        (zero_phase_ ? filter_forward_backward(sections, signal) : filter_causally(sections, signal, start_))
            .transpose();
  }
  const double lasting = settling(interval);
  const char* ends = zero_phase_ ? "at both ends" : "at the start";
  std::string text = fmt::format("{}, {}, of {}; its transients last {:.3g} s {}", name(),
                                 zero_phase_ ? "zero-phase" : "causal", words(record, chosen), lasting, ends);
  if (trim_) {
    const double last = record.time[record.size() - 1];
    record = record.window(record.time[0] + lasting, zero_phase_ ? last - lasting : last);
    text += ", which were cut off";
  }
  return text + ".";
}

}  // namespace beamid::experiments
