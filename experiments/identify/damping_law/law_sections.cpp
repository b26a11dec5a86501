#include "experiments/identify/damping_law/law_sections.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/identify/model_setting.hpp"
#include "experiments/signal/chi_square_limit.hpp"
#include "experiments/signal/median.hpp"

namespace beamid::experiments {

using Eigen::Index;

double displacement_per_reading(Quantity quantity, double frequency_hz) {
  const double omega = 2.0 * std::numbers::pi * frequency_hz;
  return quantity == Quantity::acceleration ? 1.0 / (omega * omega)
         : quantity == Quantity::velocity   ? 1.0 / omega
                                            : 1.0;
}

DecaySections decay_sections(const Record& record, const ModalEstimate& modal) {
  const Index row = output_channels(record)[0];
  std::vector<std::complex<double>> others;
  for (const CompanionMode& mode : modal.companions)
    others.push_back(std::polar(2.0 * std::numbers::pi * mode.frequency_hz,
                                std::acos(std::clamp(-mode.damping_ratio, -1.0, 1.0))));
  // Sections as short as a mode can be isolated in, a sixteenth of the record at least: more of them tell a
  // law from its neighbours.
  AmplitudeSettings settings;
  const double span = record.time[record.size() - 1] - record.time[0];
  settings.window = std::max(span / 16.0, 6.0 / modal.frequency_hz);
  settings.largest_deviation = 0.5;
  std::vector<AmplitudePoint> points;
  try {
    points = amplitude_dependence(record.samples.row(row).transpose(), record.interval(), modal.rate(),
                                  others, settings);
  } catch (const std::invalid_argument&) {  // shorter than the mode's isolation asks for
    return {};
  }
  DecaySections found;
  std::vector<double> frequency, damping;  // deviation times amplitude
  for (std::size_t i = 0; i < points.size(); i += 2) {
    AmplitudePoint section = points[i];
    section.amplitude *= displacement_per_reading(record.channels[row].quantity, section.frequency_hz);
    frequency.push_back(section.frequency_deviation_hz * section.amplitude);
    damping.push_back(section.damping_ratio_deviation * section.amplitude);
    found.sections.push_back(section);
  }
  for (AmplitudePoint& section : found.sections) {
    section.frequency_deviation_hz = median(frequency) / section.amplitude;
    section.damping_ratio_deviation = median(damping) / section.amplitude;
  }
  if (points.empty()) return found;
  const AmplitudePoint& last = points.back();
  const double rate = 2.0 * std::numbers::pi * last.frequency_hz * last.damping_ratio;
  found.last_amplitude = last.amplitude * std::exp(-0.5 * rate * settings.window) *
                         displacement_per_reading(record.channels[row].quantity, last.frequency_hz);
  return found;
}

LawMisfit misfit_of(const FittedLaw& law, const std::vector<AmplitudePoint>& sections, Index fitted) {
  LawMisfit misfit;
  misfit.sections = static_cast<Index>(sections.size());
  misfit.freedom = 2 * misfit.sections - fitted;
  for (const AmplitudePoint& section : sections) {
    const double ratio = law.damping_ratio(section.amplitude), off = section.damping_ratio - ratio;
    misfit.chi_square +=
        std::pow(off / section.damping_ratio_deviation, 2) +
        std::pow(
            (section.frequency_hz - law.frequency_hz(section.amplitude)) / section.frequency_deviation_hz, 2);
    if (std::abs(off) > std::abs(misfit.largest * ratio)) {
      misfit.largest = off / ratio;
      misfit.at_amplitude = section.amplitude;
    }
  }
  misfit.tested = misfit.freedom > 0;
  misfit.lacks = misfit.tested && misfit.chi_square > chi_square_limit(static_cast<double>(misfit.freedom));
  return misfit;
}

}  // namespace beamid::experiments
