#include "experiments/modal/study/driven_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/modal/hammer_response.hpp"
#include "experiments/modal/study/record_kind.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;
using Complex = std::complex<double>;
using std::numbers::pi;

/// Rows of a record, inputs or not.
MatrixXd rows_of(const Record& record, bool input, std::vector<Channel>& channels) {
  MatrixXd rows(0, record.size());
  for (Index i = 0; i < record.samples.rows(); ++i) {
    if (is_input(record.channels[static_cast<std::size_t>(i)].quantity) != input) continue;
    rows.conservativeResize(rows.rows() + 1, Eigen::NoChange);
    rows.bottomRows(1) = record.samples.row(i);
    channels.push_back(record.channels[static_cast<std::size_t>(i)]);
  }
  return rows;
}

/// From 1.5 lines of a block to where all but a thousandth of every channel's squares lie.
std::pair<double, double> reach(const MatrixXd& outputs, double interval, double block_s) {
  constexpr double highest_share = 0.45, margin = 1.1;
  const DrivenLines lines = driven_lines(outputs, outputs, interval, {0.0, highest_share / interval});
  const double highest = lines.omega[last_strong_line(lines.outputs)] / (2.0 * pi);
  return {1.5 / block_s, std::min(margin * highest, highest_share / interval)};
}

/// Stable poles, and large peaks that none of them stands for.
std::vector<DrivenMode> candidates(const StabilisationSettings& settings, const VectorXd& frequency_hz,
                                   const Eigen::MatrixXcd& responses, int power, DrivenStudy& study) {
  constexpr double smallest_peak = 0.3;
  StabilisationSettings stable = settings;
  stable.band_hz = study.band_hz;
  stable.resolution_hz = 1.0 / study.responses.duration;
  study.stabilisation = stabilise(study.orders, stable);
  std::vector<DrivenMode> found;
  for (const PoleCluster& cluster : study.stabilisation.modes)
    found.push_back({cluster.pole, cluster.orders, {}, 0.0});
  for (const Pole& peak : poles_at_peaks(frequency_hz, responses, 0.0, power, smallest_peak)) {
    const double near = std::max(2.0 * stable.resolution_hz, 2.0 * std::abs(peak.rate.real()) / (2.0 * pi));
    if (std::none_of(found.begin(), found.end(), [&](const DrivenMode& mode) {
          return std::abs(mode.pole.frequency_hz() - peak.frequency_hz()) < near;
        }))
      found.push_back({peak, {}, {}, 0.0});
  }
  return found;
}

std::string follows_amplitude(double other_hz) {
  return fmt::format(
      "moves as the mode at {:.4g} Hz does: a frequency or a damping that follows the amplitude", other_hz);
}

/// The mode that moves as mode m does, and near it: within a tenth of the frequency or three widths. -1:
/// none.
Index companion_of(const DrivenPoles& fit, Index m) {
  constexpr double near = 0.1, widths = 3.0, same = 0.9;
  const Complex rate = fit.rates[static_cast<std::size_t>(m)];
  for (Index other = 0; other < fit.ratio.size(); ++other) {
    const Complex there = fit.rates[static_cast<std::size_t>(other)];
    const double apart = std::abs(std::abs(there) - std::abs(rate)),
                 width = 2.0 * std::max(std::abs(there.real()), std::abs(rate.real()));
    if (other != m && apart < std::max(near * std::abs(rate), widths * width) &&
        modal_assurance(fit.residual_shapes.col(m), fit.residual_shapes.col(other)) > same)
      return other;
  }
  return -1;
}

/// Why a mode of the fit is none; empty: it is one.
std::string objection_to(const ModalStudySettings& settings, const DrivenStudy& study, Index m) {
  constexpr double least_ratio = 5.0;  // of squares that go with a mode over those of noise around it
  const DrivenPoles& fit = study.fit;
  const Complex rate = fit.rates[static_cast<std::size_t>(m)];
  const StabilisationSettings& limits = settings.stabilisation;
  const double hz = std::abs(rate) / (2.0 * pi), ratio = -rate.real() / std::abs(rate),
               deviation = std::sqrt(std::max(0.0, fit.covariance(2 * m, 2 * m)));
  if (hz < study.band_hz.first || hz > study.band_hz.second)
    return "runs out of the band in the least squares";
  if (ratio > limits.largest_damping_ratio)
    return fmt::format("damping ratio above {:.3g} %", 100.0 * limits.largest_damping_ratio);
  if (!(fit.ratio[m] > least_ratio)) return "no more than the noise around it";
  if (!(deviation < limits.largest_frequency_deviation))
    return fmt::format("frequency known to {:.2g} % only", 100.0 * deviation);
  if (const Index other = companion_of(fit, m);
      other >= 0 && study.modes[static_cast<std::size_t>(m)].orders.empty())
    return follows_amplitude(std::abs(fit.rates[static_cast<std::size_t>(other)]) / (2.0 * pi));
  if (fit.share[m] < settings.smallest_amplitude * fit.share.maxCoeff())
    return fmt::format("motion below {:.2g} % of the strongest", 100.0 * settings.smallest_amplitude);
  return {};
}

/// Fits all lines, and takes the worst mode out until each is one.
void keep_modes(const ModalStudySettings& settings, DrivenStudy& study) {
  std::vector<DrivenMode>& modes = study.modes;
  while (!modes.empty()) {
    std::vector<Complex> rates;
    for (const DrivenMode& mode : modes) rates.push_back(mode.pole.rate);
    study.fit = fit_driven_poles(study.lines, rates);
    std::size_t worst = modes.size();
    std::string why;
    for (std::size_t m = 0; m < modes.size(); ++m) {
      const std::string objection = objection_to(settings, study, static_cast<Index>(m));
      if (objection.empty() || (worst < modes.size() && study.fit.ratio[static_cast<Index>(m)] >=
                                                            study.fit.ratio[static_cast<Index>(worst)]))
        continue;
      worst = m;
      why = objection;
    }
    if (worst == modes.size()) break;
    study.stabilisation.rejected.push_back({modes[worst].pole, modes[worst].orders, why});
    modes.erase(modes.begin() + static_cast<std::ptrdiff_t>(worst));
  }
}

/// Modes that no order showed as stable, one at a time, as long as each is one and drives none out.
void add_missed(const ModalStudySettings& settings, DrivenStudy& study) {
  constexpr std::size_t most_modes = 16;
  const VectorXd size = study.lines.outputs.cwiseAbs2().rowwise().mean().cwiseSqrt();
  while (study.modes.size() < most_modes) {
    DrivenStudy more = study;
    const std::vector<Complex> rates = study.modes.empty() ? std::vector<Complex>() : study.fit.rates;
    Pole pole{next_pole(study.lines, rates, study.modes.empty() ? size : study.fit.left),
              VectorXcd::Ones(study.lines.outputs.rows())};
    for (std::size_t m = 0; m < more.modes.size(); ++m) more.modes[m].pole.rate = study.fit.rates[m];
    more.modes.push_back({pole, {}, {}, 0.0});
    keep_modes(settings, more);
    if (more.modes.size() <= study.modes.size()) break;
    study = std::move(more);
  }
}

/// The strongest ones only, where a number is asked for.
void keep_strongest(int count, DrivenStudy& study) {
  if (count <= 0 || static_cast<std::size_t>(count) >= study.modes.size()) return;
  std::vector<std::pair<double, DrivenMode>> sorted;
  for (std::size_t m = 0; m < study.modes.size(); ++m)
    sorted.emplace_back(study.fit.share[static_cast<Index>(m)], study.modes[m]);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  study.modes.clear();
  std::vector<Complex> rates;
  for (int m = 0; m < count; ++m) {
    study.modes.push_back(sorted[static_cast<std::size_t>(m)].second);
    rates.push_back(study.modes.back().pole.rate);
  }
  study.fit = fit_driven_poles(study.lines, rates);
}

/// Sections of at least 20 periods of the lowest mode, six to twenty; none where they would be fewer.
std::vector<DrivenLines> sections_of(const MatrixXd& outputs, const MatrixXd& inputs, double interval,
                                     double lowest_hz, std::pair<double, double> band_hz) {
  constexpr double fewest_periods = 20.0;
  constexpr Index fewest = 6, most = 20;
  const double periods = lowest_hz * interval * static_cast<double>(outputs.cols());
  const Index count = std::min(most, static_cast<Index>(periods / fewest_periods));
  std::vector<DrivenLines> found;
  if (count < fewest) return found;
  const Index length = outputs.cols() / count;
  for (Index i = 0; i < count; ++i)
    found.push_back(driven_lines(outputs.middleCols(i * length, length),
                                 inputs.middleCols(i * length, length), interval, band_hz));
  return found;
}

/// Poles with deviations, shapes and participations, by rising frequency.
void complete_modes(const VectorXd& powers, DrivenStudy& study) {
  const auto p = static_cast<Index>(study.outputs.size()), m = static_cast<Index>(study.inputs.size());
  const DrivenPoles& fit = study.fit;
  for (std::size_t k = 0; k < study.modes.size(); ++k) {
    DrivenMode& mode = study.modes[k];
    const auto at = static_cast<Index>(k);
    mode.pole.rate = fit.rates[k];
    mode.pole.frequency_deviation_hz =
        mode.pole.frequency_hz() * std::sqrt(std::max(0.0, fit.covariance(2 * at, 2 * at)));
    mode.pole.damping_ratio_deviation =
        mode.pole.damping_ratio() * std::sqrt(std::max(0.0, fit.covariance(2 * at + 1, 2 * at + 1)));
    mode.share = fit.share[at];
    mode.participation.resize(p * m);
    for (Index j = 0; j < m; ++j) {
      const double sign = study.inputs[static_cast<std::size_t>(j)].quantity == Quantity::force ? 1.0 : -1.0;
      for (Index i = 0; i < p; ++i)
        mode.participation[i + p * j] =
            sign * fit.residual_shapes(i + p * j, at) / std::pow(mode.pole.rate, powers[i]);
    }
    Index input = 0, largest = 0;
    mode.participation.reshaped(p, m).colwise().norm().maxCoeff(&input);
    mode.pole.shape = mode.participation.segment(p * input, p);
    mode.pole.shape.cwiseAbs().maxCoeff(&largest);
    mode.pole.shape /= Complex(mode.pole.shape[largest]);
  }
  std::sort(study.modes.begin(), study.modes.end(), [](const DrivenMode& a, const DrivenMode& b) {
    return a.pole.frequency_hz() < b.pole.frequency_hz();
  });
}

/// Deviations from the scatter over sections where it is larger, then the modes.
void complete(const std::vector<DrivenLines>& sections, const VectorXd& powers, DrivenStudy& study) {
  if (!sections.empty()) {
    study.sections = static_cast<int>(sections.size());
    const MatrixXd scatter = scatter_over(sections, study.fit);
    const double student = student_factor(static_cast<double>(sections.size()) - 2.0);
    for (Index a = 0; a < scatter.rows(); ++a) {
      const double by_lines = std::sqrt(study.fit.covariance(a, a)),
                   by_sections = student * std::sqrt(std::max(0.0, scatter(a, a)));
      if (by_sections > by_lines) {
        study.fit.covariance.row(a) *= by_sections / by_lines;
        study.fit.covariance.col(a) *= by_sections / by_lines;
      }
    }
  }
  complete_modes(powers, study);
}

/// Why a mode is one of the motion's nonlinearity, or of its noise, rather than of the structure; empty: it
/// is the structure's. A mode that no order showed answers little in every channel beside the modes that
/// answer most; so does one beside a stronger one of its shape.
std::string doubt_about(const DrivenStudy& study, std::size_t k) {
  constexpr double least = 0.03, least_of_same = 0.1, near = 0.1, same = 0.95, least_known = 0.3;
  const DrivenMode& mode = study.modes[k];
  VectorXd largest = VectorXd::Zero(mode.participation.size());
  for (const DrivenMode& other : study.modes) largest = largest.cwiseMax(other.participation.cwiseAbs());
  const double answer = mode.participation.cwiseAbs().cwiseQuotient(largest.cwiseMax(1e-300)).maxCoeff();
  if (mode.orders.empty() && study.modes.size() > 1 &&
      (answer < least || mode.pole.damping_ratio_deviation > least_known * mode.pole.damping_ratio()))
    return fmt::format("no order shows it, and its participation is {:.2g} % of what others have",
                       100.0 * answer);
  for (const DrivenMode& other : study.modes)
    if (&other != &mode && study.outputs.size() > 1 && mode.orders.size() < other.orders.size() &&
        std::abs(other.pole.frequency_hz() / mode.pole.frequency_hz() - 1.0) < near &&
        mode.participation.norm() < least_of_same * other.participation.norm() &&
        modal_assurance(mode.pole.shape, other.pole.shape) > same)
      return follows_amplitude(other.pole.frequency_hz());
  return {};
}

/// Takes doubtful modes out. @returns whether there were any
bool leave_out_doubtful(DrivenStudy& study) {
  std::vector<DrivenMode> kept;
  for (std::size_t k = 0; k < study.modes.size(); ++k) {
    const std::string why = doubt_about(study, k);
    if (why.empty())
      kept.push_back(study.modes[k]);
    else
      study.stabilisation.rejected.push_back({study.modes[k].pole, study.modes[k].orders, why});
  }
  const bool any = kept.size() < study.modes.size();
  study.modes = std::move(kept);
  std::vector<Complex> rates;
  for (const DrivenMode& mode : study.modes) rates.push_back(mode.pole.rate);
  if (any && !rates.empty()) study.fit = fit_driven_poles(study.lines, rates);
  return any;
}

void judge(DrivenStudy& study) {
  constexpr double healthy = 0.7, least = 0.9;
  const double explained = study.explained();
  if (study.modes.empty()) return;
  if (explained < healthy)
    study.objections.emplace_back(
        "unexplained_modes",
        fmt::format(
            "The measured input{} only {:.0f} % of the motion through these modes. Something else moves the "
            "structure, a mode is missing, or frequencies and damping are not constant: standard deviations "
            "may "
            "be too "
            "small.",
            study.inputs.size() > 1 ? "s make" : " makes", 100.0 * explained),
        explained, healthy);
  for (std::size_t k = 0; k < study.modes.size(); ++k)
    if (study.outputs.size() > 1 && phase_collinearity(study.modes[k].pole.shape) < least)
      study.objections.emplace_back(
          "channel_phases",
          fmt::format("Channels do not move in phase or in opposition in mode {} at {:.4g} Hz: clocks that "
                      "differ, a near "
                      "mode that was missed, or damping that is not classical.",
                      k + 1, study.modes[k].pole.frequency_hz()));
}

}  // namespace

DrivenStudy study_driven(const std::string& name, const Record& record, const ModalStudySettings& settings) {
  const auto method = modal_method_registry().make(settings.method.name, settings.method.options);
  DrivenStudy study;
  study.name = name;
  study.remarks = record.remarks;
  study.objections = record.objections;
  study.record = complete_part(record, study.remarks);
  check_intervals(study.record);
  const double interval = study.record.interval();
  const MatrixXd inputs = rows_of(study.record, true, study.inputs),
                 outputs = rows_of(study.record, false, study.outputs);
  if (study.inputs.empty())
    throw std::invalid_argument(
        "no input was measured; expected a channel base_acceleration or force, or "
        "another method (era, ssi_cov)");
  if (study.outputs.empty())
    throw std::invalid_argument("the record has inputs only; expected a channel of motion or strain as well");
  study.responses = input_responses(outputs, inputs, interval);
  study.band_hz = settings.band_hz ? *settings.band_hz : reach(outputs, interval, study.responses.duration);
  check_band(study.band_hz, interval, study.record.size());
  study.lines = driven_lines(outputs, inputs, interval, study.band_hz);
  const VectorXd& f = study.responses.frequency_hz;
  const Index first = std::lower_bound(f.begin(), f.end(), study.band_hz.first) - f.begin(),
              count = std::upper_bound(f.begin(), f.end(), study.band_hz.second) - f.begin() - first;
  const int order = std::min<int>(settings.largest_order, static_cast<int>(count / 3) * 2 - 2);
  if (order < 4)
    throw std::invalid_argument(fmt::format("{} lines of {:.3g} Hz in the band; expected 9 at least", count,
                                            1.0 / study.responses.duration));
  VectorXd powers(static_cast<Index>(study.outputs.size()));
  for (Index i = 0; i < powers.size(); ++i)
    powers[i] = times_differentiated(study.outputs[static_cast<std::size_t>(i)].quantity);
  const VectorXd lines = f.segment(first, count);
  const Eigen::MatrixXcd h1 = study.responses.h1.middleCols(first, count);
  study.orders = method->search_responses(lines, h1, 0.0, order);
  study.modes = candidates(settings.stabilisation, lines, h1, static_cast<int>(powers.minCoeff()), study);
  keep_modes(settings, study);
  add_missed(settings, study);
  keep_strongest(settings.modes, study);
  if (study.modes.empty()) return study;
  double lowest = 1e300;
  for (const Complex& rate : study.fit.rates) lowest = std::min(lowest, std::abs(rate) / (2.0 * pi));
  const auto sections = sections_of(outputs, inputs, interval, lowest, study.band_hz);
  complete(sections, powers, study);
  while (leave_out_doubtful(study) && !study.modes.empty()) complete(sections, powers, study);
  judge(study);
  return study;
}

DrivenOrDecaying driven_or_decaying(const std::string& name, const Record& record, bool windowed,
                                    const ModalStudySettings& settings) {
  DrivenOrDecaying found;
  ModalStudySettings by_input = settings, decay = settings;
  by_input.method = {"output_error", {}};
  decay.method = ModalStudySettings().method;
  try {
    DrivenStudy study = study_driven(name, record, by_input);
    if (!study.modes.empty()) found.driven = std::move(study);
  } catch (const std::invalid_argument&) {  // too short, or gaps
  }
  if (found.driven) try {
      RecordModes modes = find_modes(name, record, windowed, decay);
      if (modes.modes.empty()) return found;
      if (modes.left() < found.driven->fit.left_share) found.driven.reset();
      found.decaying = std::move(modes);
    } catch (const std::invalid_argument&) {  // no decay
    }
  return found;
}

void refuse_driven(const std::string& file, const Record& record, bool windowed) {
  if (!is_driven(record) || is_struck(record) || !driven_or_decaying(file, record, windowed, {}).driven)
    return;
  throw InputError({file},
                   "an input is measured that drives the motion, and what this command follows would be the "
                   "input's; expected a free decay or random vibration. 'beamid modal' and 'beamid identify' "
                   "use the input, and identify shows what follows the size of the motion");
}

RecordModes modes_of(const DrivenStudy& study) {
  RecordModes found;
  found.name = study.name;
  found.record = motion_of(study.record);
  found.remarks = study.remarks;
  found.objections = study.objections;
  found.free_decay = false;
  found.band_hz = study.band_hz;
  for (const DrivenMode& mode : study.modes)
    found.modes.push_back({mode.pole, mode.orders, mode.share * mode.share});
  return found;
}

}  // namespace beamid::experiments
