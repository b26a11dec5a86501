#include "experiments/modal/study/hammer_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/modal/force_error.hpp"
#include "experiments/modal/response_peaks.hpp"

namespace beamid::experiments {
namespace {

using Eigen::MatrixXcd, Eigen::VectorXd;

/// The peaks that count beside stable poles, over the largest.
constexpr double smallest_peak = 0.3;

std::vector<std::complex<double>> rates_of(const std::vector<HammerMode>& modes) {
  std::vector<std::complex<double>> rates;
  for (const HammerMode& mode : modes) rates.push_back(mode.pole.rate);
  return rates;
}

/// Those that stay where they are over the orders.
void take_stable(StabilisationSettings settings, HammerStudy& study) {
  settings.band_hz = study.band_hz;
  settings.resolution_hz = 1 / study.responses.duration;
  study.stabilisation = stabilise(study.orders, settings);
  for (const PoleCluster& cluster : study.stabilisation.modes)
    study.modes.push_back({cluster.pole, cluster.orders, {}, {}, {}});
}

/// Large peaks that no stable pole stands for: a frequency that follows the amplitude spreads its poles over
/// the orders, and none of them stays.
void add_peaks(const std::vector<Pole>& peaks, HammerStudy& study) {
  const double line = 1 / study.responses.duration;
  std::string added;
  for (const Pole& peak : peaks) {
    const double near = std::max(2 * line, 2 * std::abs(peak.rate.real()) / (2 * std::numbers::pi));
    if (std::any_of(study.modes.begin(), study.modes.end(), [&](const HammerMode& mode) {
          return std::abs(mode.pole.frequency_hz() - peak.frequency_hz()) < near;
        }))
      continue;
    study.modes.push_back({peak, {}, {}, {}, {}});
    added += fmt::format("{}{:.4g}", added.empty() ? "" : ", ", peak.frequency_hz());
  }
  if (added.empty()) return;
  std::sort(study.modes.begin(), study.modes.end(), [](const HammerMode& a, const HammerMode& b) {
    return a.pole.frequency_hz() < b.pole.frequency_hz();
  });
  study.warnings.push_back(
      "Peaks at " + added +
      " Hz have no pole that is stable over the orders and were taken from the lines around them: no sum of "
      "linear modes goes through all lines there. Frequencies or damping that follow the amplitude do that, "
      "and a force that is not all of what acted.");
}

/// How far the fit has carried a pole, relative; more than all others where it does not decay.
double carried(const std::complex<double>& from, const std::complex<double>& to) {
  return to.real() < 0 ? std::abs(to.imag() / from.imag() - 1) : 1e3;
}

/// All poles by least squares. The one that runs away furthest goes, and the rest is fitted anew; false, and
/// all as it was, where none is left or the fit does not converge.
bool refine(const VectorXd& lines, const MatrixXcd& measured, HammerStudy& study) {
  constexpr double farthest = 0.05;
  const double shift = study.responses.window_rate;
  const ForceErrors force = force_errors(study.responses, study.first, study.lines);
  const VectorXd& spectrum = study.responses.force_spectrum;
  const ResponseNoise noise{
      {shift * study.responses.duration,
       spectrum.segment(study.first, study.lines).cwiseMax(1e-6 * spectrum.maxCoeff()).cwiseInverse()},
      force.noise,
      force.aliases};
  const HammerStudy before = study;
  try {
    while (true) {
      const std::vector<std::complex<double>> rates = rates_of(study.modes);
      ResidueFit refined = refine_poles(lines, measured, shift, study.power, rates, noise);
      std::size_t worst = 0;
      for (std::size_t m = 1; m < rates.size(); ++m)
        if (carried(rates[m], refined.rates[m]) > carried(rates[worst], refined.rates[worst])) worst = m;
      if (carried(rates[worst], refined.rates[worst]) < farthest) {
        study.fit = std::move(refined);
        return true;
      }
      const HammerMode& lost = study.modes[worst];
      const std::string why = fmt::format("the pole at {:.4g} Hz runs away", lost.pole.frequency_hz());
      if (rates.size() == 1) throw std::runtime_error(why);
      study.warnings.push_back("Least squares of all poles: " + why + " and was left out.");
      study.stabilisation.rejected.push_back({lost.pole, lost.orders, "runs away in the least squares"});
      study.modes.erase(study.modes.begin() + static_cast<std::ptrdiff_t>(worst));
    }
  } catch (const std::runtime_error& error) {
    study = before;
    study.warnings.push_back(std::string("Poles are as they were found at first, without deviations: ") +
                             error.what() + ".");
    return false;
  }
}

}  // namespace

void choose_modes(const StabilisationSettings& settings, const VectorXd& lines, const MatrixXcd& measured,
                  HammerStudy& study) {
  take_stable(settings, study);
  add_peaks(poles_at_peaks(lines, measured, study.responses.window_rate, study.power, smallest_peak), study);
}

void fit_modes(const VectorXd& lines, const MatrixXcd& measured, bool refined, HammerStudy& study) {
  const double shift = study.responses.window_rate;
  const auto fit = [&] { return fit_residues(lines, measured, shift, study.power, rates_of(study.modes)); };
  study.fit = fit();
  if (!refined || refine(lines, measured, study)) return;
  HammerStudy anew = study;
  anew.modes.clear();
  anew.warnings.back() =
      "Least squares do not keep the poles that are stable over the orders; those at the peaks took their "
      "place.";
  for (const Pole& peak : poles_at_peaks(lines, measured, shift, study.power, smallest_peak))
    anew.modes.push_back({peak, {}, {}, {}, {}});
  if (!anew.modes.empty() && refine(lines, measured, anew)) study = std::move(anew);
}

}  // namespace beamid::experiments
