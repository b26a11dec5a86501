#include "experiments/identify/backbone/whole_record_fit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "experiments/identify/backbone/loop_fitter.hpp"
#include "experiments/identify/backbone/model_ranking.hpp"
#include "experiments/identify/backbone/registered_fit.hpp"
#include "experiments/identify/model_setting.hpp"
#include "experiments/signal/decimation.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

/// What all steps of the fit are given.
struct WholeRecord {
  const AmplitudeWindows& windows;
  const RecordFitStart& start;
  DecaySamples samples;
  double damping = 0;  ///< mean of the windows [N s/m]
};

WholeRecord whole_record(const Record& record, const AmplitudeWindows& windows, const RecordFitStart& start,
                         double samples_per_period) {
  const Index row = output_channels(record)[0];
  double fastest = 0, damping = 0;
  for (const AmplitudeWindow& window : windows.windows) {
    fastest = std::max(fastest, window.frequency_hz);
    damping += window.damping / static_cast<double>(windows.windows.size());
  }
  return {windows, start,
          decay_samples(record.samples.row(row).transpose(), record.interval(),
                        record.channels[static_cast<std::size_t>(row)].quantity, fastest, samples_per_period),
          damping};
}

/// Springs, elastic, with Masing's loop and between them.
/// @return where the models registered begin: motion and offset count
LoopStart fit_springs(const WholeRecord& on, ModelRanking& to) {
  const AmplitudeWindows& windows = on.windows;
  const double omega = 2 * std::numbers::pi * windows.windows.front().frequency_hz,
               range = 1.03 * std::max(std::abs(windows.start), windows.first_amplitude);
  const Complex phasor = windows.start * std::exp(Complex(0, omega * on.samples.lost));
  const LoopFitter fitter(on.samples, on.start.mass, windows.noise, omega);
  const auto constant = [](double value) { return [value](double) { return value; }; };
  LoopStart from{constant(on.start.elastic.secant(0.5 * windows.first_amplitude)),
                 constant(on.damping),
                 0,
                 {phasor.real(), (phasor * Complex(0, omega)).real()},
                 0};
  to.fits.push_back(fitter.fit("linear", 1, 1, range, from, true));

  from.secant = [&](double x) { return on.start.elastic.secant(x); };
  fitter.refine("elastic", {{4, 1}, {6, 1}, {8, 1}, {6, 2}, {6, 4}}, range, from, to.fits);

  LoopStart loop = from;
  loop.secant = [&](double x) { return on.start.masing.secant(x); };
  loop.damping = constant(std::max(0.1 * on.damping, windows.windows.back().damping));
  loop.masing = 1;
  fitter.refine("masing", {{4, 1}, {6, 1}, {8, 1}}, 0.95 * range, loop, to.fits);

  const RecordFit* const better = std::isfinite(to.noise()) ? to.best_spring() : nullptr;
  if (!better) return from;
  const RecordFit near = *better;
  to.fits.push_back(fitter.fit("between", near.spring.curve.terms(), near.damping.size(),
                               near.spring.curve.range(), start_after(near), false));
  from.motion = near.motion, from.offset = near.offset;
  return from;
}

void fit_registered(const WholeRecord& on, const LoopStart& from, ModelRanking& to) {
  const ForceLaw& elastic = on.start.elastic;
  const double k0 = elastic.secant(0), size = on.windows.first_amplitude, middle = elastic.secant(0.5 * size),
               cubic = (elastic.secant(size) - k0) / (size * size), damping = on.damping;
  const auto add = [&](const char* name, const std::vector<ModelStart>& starts) {
    to.fits.push_back(
        registered_fit(name, on.samples, on.start.mass, on.windows.noise, from.motion, from.offset, starts));
  };
  add("duffing", {{{"stiffness", k0}, {"damping", damping}, {"cubic_stiffness", cubic}},
                  {{"stiffness", middle}, {"damping", damping}, {"cubic_stiffness", 0.3 * cubic}}});
  std::vector<ModelStart> hysteretic;
  for (const double yield : {0.3, 1.5})
    hysteretic.push_back({{"stiffness", std::max(k0, 0.1 * middle)},
                          {"damping", std::max(0.3 * damping, 0.0)},
                          {"post_yield_ratio", 0.3},
                          {"hysteresis_beta", 0.5 / (yield * size)},
                          {"hysteresis_gamma", 0.5 / (yield * size)}});
  add("bouc_wen", hysteretic);
}

/// Places of the least BIC, of all that converged and of those with a spline.
void choose_best(RecordFits& result) {
  const auto better = [&](const RecordFit& fit, int than) {
    return than < 0 || fit.bic < result.fits[static_cast<std::size_t>(than)].bic;
  };
  for (std::size_t i = 0; i < result.fits.size(); ++i) {
    const RecordFit& fit = result.fits[i];
    if (!fit.converged) continue;
    const auto place = static_cast<int>(i);
    if (better(fit, result.best)) result.best = place;
    if (fit.damping.size() > 0 && better(fit, result.law)) result.law = place;
  }
}

/// RecordFits::lack
double lack_of(const RecordFit& law, const WholeRecord& on, double record_start, int decimation) {
  const AmplitudeWindows& windows = on.windows;
  const int more = std::max(1, windows.decimation / decimation);
  if (law.residuals.size() < 20 * more + 24) return 0;
  const DecimatedSignal left = decimate(law.residuals, on.samples.interval(), more);
  const double before = record_start + on.samples.lost + left.start, smallest = 1e-7 * on.samples.peak();
  double sum = 0;
  for (const AmplitudeWindow& window : windows.windows) {
    const Index from = std::max<Index>(0, std::lround((window.from - before) / left.interval)),
                to = std::min<Index>(left.samples.size(), std::lround((window.to - before) / left.interval));
    if (to - from < 2) continue;
    sum += left.samples.segment(from, to - from).squaredNorm() / static_cast<double>(to - from) /
           std::pow(std::max(window.left, smallest), 2);
  }
  return sum / static_cast<double>(windows.windows.size());
}

}  // namespace

const RecordFit* RecordFits::find(const std::string& name) const {
  for (const RecordFit& fit : fits)
    if (fit.name == name && fit.converged) return &fit;
  return nullptr;
}

RecordFits fit_whole_record(const Record& record, const AmplitudeWindows& windows,
                            const RecordFitStart& start, double samples_per_period) {
  const WholeRecord on = whole_record(record, windows, start, samples_per_period);
  RecordFits result;
  result.decimation = on.samples.factor;
  ModelRanking models(on.samples);
  const LoopStart from = fit_springs(on, models);
  if (!std::isfinite(models.noise())) return result;
  fit_registered(on, from, models);
  result.noise = models.noise();
  const double scale = result.noise * result.noise / on.samples.whiteness / (windows.noise * windows.noise);
  result.fits = models.best_of_each(result.noise, scale);
  choose_best(result);
  if (result.law >= 0)
    result.lack =
        lack_of(result.fits[static_cast<std::size_t>(result.law)], on, record.time[0], result.decimation);
  return result;
}

}  // namespace beamid::experiments
