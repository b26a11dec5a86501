#include "experiments/identify/backbone/backbone_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/modal/close_pair.hpp"
#include "experiments/models/estimates.hpp"

namespace beamid::experiments {
namespace {

constexpr double least_ratio = 1.5;    // of amplitudes, from which a law shows
constexpr double largest_half = 0.05;  // of the change's interval, beyond which nothing is said
constexpr double largest_lack = 1.5;   // of the residuals' variance, for the whole record's law
constexpr double strong_bic = 10;      // from which one model is clearly better than another
constexpr double other_motion = 0.3;   // beside the mode

void take_change(const BackboneSettings& settings, BackboneStudy& study) {
  const auto& windows = study.windows.windows;
  const auto [low, high] = std::minmax_element(
      windows.begin(), windows.end(), [](const auto& a, const auto& b) { return a.amplitude < b.amplitude; });
  study.ratio = high->amplitude / low->amplitude;
  const ForceLaw curve = invert_windows(windows, study.secants.curve.range(), WindowReading::secant, 2);
  const Eigen::VectorXd first = curve.curve.shape(low->amplitude),
                        step = curve.curve.shape(high->amplitude) - first;
  const double k0 = first.dot(curve.coefficients);
  study.change = step.dot(curve.coefficients) / k0;
  const Eigen::VectorXd slope = step - study.change * first;
  study.change_deviation = std::sqrt(std::max(0.0, slope.dot(curve.covariance * slope))) / k0;
  const double half = quantile_95 * study.change_deviation;
  if (windows.size() < 3 || study.ratio < least_ratio || half > largest_half) return;
  const double size = std::abs(study.change);
  if (size < half && half > settings.linear) return;  // neither seen nor excluded
  study.spring = size < std::max(half, settings.linear) ? SpringKind::linear
                 : study.change < 0                     ? SpringKind::softening
                                                        : SpringKind::hardening;
}

/// Elastic, Masing's, or between, by the law of least BIC and by mu of the model that has it free.
LoopKind loop_of(const BackboneStudy& study) {
  if (study.spring == SpringKind::linear) return LoopKind::none;
  const RecordFit *const law = study.law(), *const between = study.record.find("between");
  if (study.spring == SpringKind::not_determined || !law || !between) return LoopKind::not_determined;
  constexpr double coarse = 0.25, same = 0.1;
  const double half = quantile_95 * between->masing_deviation, mu = between->masing;
  const RecordFit *const elastic = study.record.find("elastic"), *const masing = study.record.find("masing");
  constexpr double none = std::numeric_limits<double>::infinity();
  const double elastic_bic = elastic ? elastic->bic : none, masing_bic = masing ? masing->bic : none,
               tolerance = std::max(same, half);
  if (!(half < coarse)) return LoopKind::not_determined;
  if (std::abs(mu) < tolerance && masing_bic - elastic_bic > strong_bic) return LoopKind::elastic;
  if (std::abs(mu - 1) < tolerance && elastic_bic - masing_bic > strong_bic) return LoopKind::masing;
  return mu > tolerance && mu < 1 - tolerance && std::min(elastic_bic, masing_bic) - between->bic > strong_bic
             ? LoopKind::between
             : LoopKind::not_determined;
}

/// A beat of two modes is a stiffness and a damping that follow the amplitude, to windows.
std::optional<Objection> two_modes(const Record& record, const BackboneStudy& study) {
  const Eigen::VectorXd signal = record.samples.row(output_channels(record).front()).transpose();
  ModalAnalysisSettings near;
  near.expected_frequency_hz = study.windows.windows.front().frequency_hz;
  try {
    const auto decay =
        fitted_decay(signal, record.interval(), dominant_mode(signal, record.interval(), near));
    const auto pair = decay ? close_pair(*decay) : std::nullopt;
    if (!pair || !pair->contradicts_one()) return {};
    return Objection(pair->objection(),
                     pair->sentence(*near.expected_frequency_hz) +
                         " Windows of falling amplitude take the beat of two for a force law.",
                     pair->over_drift, clearly_two);
  } catch (const std::exception&) {  // no mode of one frequency: as a strong spring has
    return {};
  }
}

}  // namespace

const char* to_string(SpringKind kind) {
  return kind == SpringKind::linear      ? "linear"
         : kind == SpringKind::softening ? "softening"
         : kind == SpringKind::hardening ? "hardening"
                                         : "not determined";
}

const char* to_string(LoopKind kind) {
  return kind == LoopKind::none      ? "none"
         : kind == LoopKind::elastic ? "elastic"
         : kind == LoopKind::masing  ? "masing"
         : kind == LoopKind::between ? "between"
                                     : "not determined";
}

const RecordFit* BackboneStudy::law() const {
  return by_record ? &record.fits[static_cast<std::size_t>(record.law)] : nullptr;
}

double BackboneStudy::largest() const {
  if (law()) return law()->largest;
  double found = 0;
  for (const AmplitudeWindow& window : windows.windows) found = std::max(found, window.amplitude);
  return found;
}

double BackboneStudy::linear_bic() const {
  const RecordFit* const linear = record.find("linear");
  return linear && record.law >= 0 ? linear->bic - record.fits[static_cast<std::size_t>(record.law)].bic
                                   : std::numeric_limits<double>::infinity();
}

double BackboneStudy::energy(double amplitude, double omega) const {
  const RecordFit* const fit = law();
  if (!fit) return std::numeric_limits<double>::quiet_NaN();
  return fit->masing * masing_energy(fit->spring.curve, amplitude).dot(fit->spring.coefficients) +
         std::numbers::pi * omega * amplitude * amplitude *
             equivalent_damping(fit->damping_curve, amplitude).dot(fit->damping);
}

BackboneStudy study_backbone(const Record& record, const BackboneSettings& settings) {
  BackboneStudy study;
  study.windows = amplitude_windows(record, settings.windows);
  auto& windows = study.windows.windows;
  const double range = 1.03 * std::max(std::abs(study.windows.start), study.windows.first_amplitude);
  study.elastic = invert_windows(windows, range, WindowReading::elastic);
  const auto largest = [&](double harmonic) { return amplitude_of_harmonic(study.elastic, harmonic); };
  for (AmplitudeWindow& window : windows) {
    for (double& node : window.nodes) node = largest(node);
    window.amplitude = largest(window.amplitude);
  }
  study.windows.first_amplitude = largest(study.windows.first_amplitude);
  study.windows.last_amplitude = largest(study.windows.last_amplitude);
  study.secants = invert_windows(windows, range, WindowReading::secant);
  study.masing = invert_windows(windows, range, WindowReading::masing);
  take_change(settings, study);
  if (study.windows.largest_other > other_motion)
    study.objections.emplace_back(
        "other_motion",
        fmt::format("Beside the mode there is other motion of {:.0f} % of its amplitude: another mode, noise "
                    "or a motion that is no decay.",
                    100 * study.windows.largest_other));
  if (auto two = two_modes(record, study)) study.objections.push_back(*std::move(two));
  for (const double samples_per_period : {24.0, 8.0}) {  // the second ends other modes, and harmonics
    try {
      study.record = fit_whole_record(
          record, study.windows, {study.elastic, study.masing, settings.windows.mass}, samples_per_period);
    } catch (const std::exception& error) {
      study.objections.emplace_back(
          "no_law", fmt::format("No force law could be fitted to the whole record: {}.", error.what()));
      break;
    }
    study.by_record = study.record.law >= 0 && study.record.lack < largest_lack;
    if (study.by_record || study.windows.decimation == study.record.decimation) break;
  }
  study.loop = loop_of(study);
  study.backbone = study.law() ? study.law()->spring : study.elastic;
  if (!study.law()) {  // what windows neglect, beside their own deviations
    const double neglected = 0.01 * std::min(1.0, std::abs(study.change));
    const double middle = study.backbone.secant(0.5 * study.largest());
    study.backbone.covariance.diagonal().array() += std::pow(neglected * middle, 2);
  }
  return study;
}

double BackboneStudy::first_amplitude() const {
  constexpr double fallen = 1.0 / 7.0, determined = 0.05;
  const bool at_rest = law() && smallest() < fallen * largest() &&
                       quantile_95 * backbone.secant_deviation(0.0) < determined * backbone.secant(0.0);
  return at_rest ? 0.0 : smallest();
}

double BackboneStudy::ratio_deviation(double x) const {
  const Eigen::VectorXd slope = backbone.curve.shape(x) / backbone.secant(x) -
                                backbone.curve.shape(first_amplitude()) / first_stiffness();
  return std::sqrt(std::max(0.0, slope.dot(backbone.covariance * slope)));
}

std::string backbone_verdict(const BackboneStudy& study) {
  const auto& w = study.windows;
  const std::string span = fmt::format("from {:.3g} to {:.3g} mm", 1e3 * w.first_amplitude,
                                       1e3 * w.last_amplitude),
                    change = fmt::format(
                        "K(A) changes by {:+.2f} +- {:.2f} % from the smallest window to the largest",
                        100 * study.change, 100 * quantile_95 * study.change_deviation);
  if (study.spring == SpringKind::not_determined) {
    if (w.windows.size() < 3)
      return fmt::format("Force law not determined: {} window{} only; {}.", w.windows.size(),
                         w.windows.size() == 1 ? "" : "s", w.ended);
    if (study.ratio < least_ratio)
      return fmt::format(
          "Force law not determined: the amplitude changes by a factor {:.2f} only ({}); expected {:.1f} at "
          "least.",
          study.ratio, span, least_ratio);
    return fmt::format("Force law not determined: {}, {}.", change, span);
  }
  if (study.spring == SpringKind::linear) {
    const bool seen = std::abs(study.change) > quantile_95 * study.change_deviation;
    if (seen)
      return fmt::format("Nearly linear {}: {}: a change that the record shows, but below the limit.", span,
                         change);
    return fmt::format("Linear {}: {}{}.", span, change,
                       study.law() && study.linear_bic() < strong_bic
                           ? ", and no other model explains more of the record"
                           : "");
  }
  const double x = study.largest();
  std::string text = fmt::format(
      "{} {}: {}; at {:.3g} mm the backbone's secant is {:.1f} % of that at {}, known within {:.2g} %.",
      study.spring == SpringKind::softening ? "Softening" : "Hardening", span, change, 1e3 * x,
      100 * study.backbone.secant(x) / study.first_stiffness(), study.first_place(),
      100 * quantile_95 * study.ratio_deviation(x));
  const RecordFit* const between = study.record.find("between");
  const std::string mu = between ? fmt::format("{:.3f} +- {:.3f} of Masing's loop", between->masing,
                                               quantile_95 * between->masing_deviation)
                                 : "";
  text += study.loop == LoopKind::masing    ? " Its loop is Masing's: " + mu + "."
          : study.loop == LoopKind::elastic ? " It is elastic: " + mu + "."
          : study.loop == LoopKind::between ? " Its loop lies between: " + mu + "."
                                            : " Whether its loop is Masing's is not determined.";
  if (!study.law())
    text +=
        " None of these laws describes the whole record: the backbone is that of the windows, as if elastic.";
  return text;
}

}  // namespace beamid::experiments
