#include "experiments/modal/study/merged_modes.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

MergedValue merged(const std::vector<double>& values, const std::vector<double>& deviations) {
  const auto count = static_cast<double>(values.size());
  const bool known = std::all_of(deviations.begin(), deviations.end(), [](double d) { return d > 0; });
  double weight = 0, sum = 0, square = 0, chi_square = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double w = known ? 1 / (deviations[i] * deviations[i]) : 1;
    weight += w;
    sum += w * values[i];
  }
  MergedValue result;
  result.mean = sum / weight;
  for (const double value : values) square += std::pow(value - result.mean, 2);
  result.deviation = known ? std::sqrt(1 / weight) : Pole::unknown;
  result.scatter = count > 1 ? std::sqrt(square / (count * (count - 1))) : Pole::unknown;
  if (known && count > 1) {
    for (std::size_t i = 0; i < values.size(); ++i)
      chi_square += std::pow((values[i] - result.mean) / deviations[i], 2);
    result.scattered = chi_square > chi_square_limit(count - 1);
  }
  return result;
}

bool same(const Pole& a, const Pole& b) {
  return std::abs(a.frequency_hz() - b.frequency_hz()) < 0.05 * a.frequency_hz() &&
         modal_assurance(a.shape, b.shape) >= 0.8;
}

}  // namespace

int MergedMode::records() const {
  return static_cast<int>(std::count_if(places.begin(), places.end(), [](int at) { return at >= 0; }));
}

std::vector<MergedMode> merge_modes(const std::vector<RecordModes>& records) {
  std::vector<MergedMode> merged_modes;
  std::vector<Pole> first;  // of each merged mode, where it was met first
  for (std::size_t r = 0; r < records.size(); ++r)
    for (std::size_t m = 0; m < records[r].modes.size(); ++m) {
      const Pole& pole = records[r].modes[m].pole;
      std::size_t best = merged_modes.size();
      for (std::size_t k = 0; k < merged_modes.size(); ++k)
        if (merged_modes[k].places[r] < 0 && same(first[k], pole) &&
            (best == merged_modes.size() ||
             std::abs(first[k].rate - pole.rate) < std::abs(first[best].rate - pole.rate)))
          best = k;
      if (best == merged_modes.size()) {
        merged_modes.push_back({std::vector<int>(records.size(), -1), {}, {}});
        first.push_back(pole);
      }
      merged_modes[best].places[r] = static_cast<int>(m);
    }
  for (MergedMode& mode : merged_modes) {
    std::vector<double> frequency, frequency_deviation, damping, damping_deviation;
    for (std::size_t r = 0; r < records.size(); ++r) {
      if (mode.places[r] < 0) continue;
      const Pole& pole = records[r].modes[mode.places[r]].pole;
      frequency.push_back(pole.frequency_hz());
      frequency_deviation.push_back(pole.frequency_deviation_hz);
      damping.push_back(pole.damping_ratio());
      damping_deviation.push_back(pole.damping_ratio_deviation);
    }
    mode.frequency_hz = merged(frequency, frequency_deviation);
    mode.damping_ratio = merged(damping, damping_deviation);
  }
  std::sort(merged_modes.begin(), merged_modes.end(), [](const MergedMode& a, const MergedMode& b) {
    return a.frequency_hz.mean < b.frequency_hz.mean;
  });
  return merged_modes;
}

}  // namespace beamid::experiments
