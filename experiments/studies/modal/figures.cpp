#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/signal/amplitude_spectrum.hpp"
#include "experiments/studies/modal/report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

VectorXd of(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
}

/// The channels' spectra together, sqrt(sum of squares), each over its own peak.
VectorXd joint_spectrum(const Eigen::MatrixXd& samples, double interval, VectorXd& frequency_hz) {
  VectorXd squares;
  for (Index i = 0; i < samples.rows(); ++i) {
    const AmplitudeSpectrum one = amplitude_spectrum(samples.row(i).transpose(), interval);
    frequency_hz = one.frequency_hz;
    if (i == 0) squares = VectorXd::Zero(frequency_hz.size());
    squares += (one.amplitude / std::max(one.amplitude.maxCoeff(), 1e-300)).cwiseAbs2();
  }
  return squares.cwiseSqrt();
}

Figure diagram(const RecordModes& found, const std::string& suffix) {
  Panel panel{found.name, {"frequency [Hz]"}, {"model order"}, {}};
  const double top = found.search.orders.empty() ? 2 : found.search.orders.back().order + 1;
  VectorXd frequency;
  const VectorXd spectrum = joint_spectrum(found.target, found.interval, frequency);
  const VectorXd decibels = spectrum.cwiseMax(1e-300).array().log10();
  const double peak = decibels.maxCoeff(), floor = std::max(decibels.minCoeff(), peak - 4);
  panel.curves.push_back({"spectrum (logarithmic, four decades at most)",
                          frequency,
                          (top * (decibels.array() - floor) / (peak - floor)).cwiseMax(0).matrix(),
                          CurveStyle::line,
                          {},
                          {},
                          Colour::grey});
  const struct {
    Stability stability;
    const char* label;
    CurveStyle style;
    Colour colour;
  } kinds[] = {{Stability::unstable, "not stable", CurveStyle::open_points, Colour::grey},
               {Stability::frequency, "stable in frequency", CurveStyle::open_points, Colour::orange},
               {Stability::full, "stable", CurveStyle::points, Colour::blue}};
  for (const auto& kind : kinds) {
    std::vector<double> x, y;
    for (const DiagramPole& pole : found.stabilisation.poles) {
      if (pole.stability != kind.stability) continue;
      x.push_back(pole.pole.frequency_hz());
      y.push_back(pole.order);
    }
    if (!x.empty()) panel.curves.push_back({kind.label, of(x), of(y), kind.style, {}, {}, kind.colour});
  }
  for (const ModeEstimate& mode : found.modes)
    panel.curves.push_back({&mode == &found.modes.front() ? "mode" : "",
                            Eigen::Vector2d::Constant(mode.pole.frequency_hz()),
                            Eigen::Vector2d(0, top),
                            CurveStyle::dashed,
                            {},
                            {},
                            Colour::vermillion});
  panel.x_axis.range = found.band_hz;
  panel.y_axis.range = {0, top};
  return {"stabilisation" + suffix, {panel}, 1, 1, 800, 520};
}

std::string modal_study_unit_of(const RecordModes& found, Index channel) {
  const std::string unit = si_unit(found.record.channels[channel].quantity);
  return found.free_decay ? unit : "(" + unit + ")^{2}";
}

Figure reproduction(const RecordModes& found, const std::string& suffix) {
  const Index shown = std::min<Index>(found.target.rows(), 4);
  Figure figure{"reproduction" + suffix, {}, static_cast<int>(shown), 2, 1000};
  figure.height = 60 + 300 * static_cast<int>(shown);
  const Index count = found.target.cols();
  const double begin = found.free_decay ? found.start : found.interval;
  const VectorXd time =
      VectorXd::LinSpaced(count, begin, begin + found.interval * static_cast<double>(count - 1));
  for (Index i = 0; i < shown; ++i) {
    const Channel& channel = found.record.channels[i];
    const std::string what = found.free_decay ? to_string(channel.quantity) : "autocorrelation";
    const VectorXd measured = found.target.row(i), again = found.reproduced.row(i);
    Panel motion{channel.name,
                 {found.free_decay ? "time [s]" : "lag [s]"},
                 {what + " [" + modal_study_unit_of(found, i) + "]"},
                 {}};
    motion.curves = {{"measured", time, measured, CurveStyle::line, {}, {}, Colour::grey},
                     {"reproduced by the modes", time, again, CurveStyle::dashed, {}, {}, Colour::blue}};
    motion.x_axis.range = {time[0], time[count - 1]};
    const AmplitudeSpectrum a = amplitude_spectrum(measured, found.interval),
                            b = amplitude_spectrum(again, found.interval);
    Panel spectrum{"", {"frequency [Hz]"}, {"amplitude [" + modal_study_unit_of(found, i) + "]", true}, {}};
    const double peak = a.amplitude.maxCoeff();
    spectrum.curves = {{"measured",
                        a.frequency_hz,
                        a.amplitude.cwiseMax(1e-6 * peak),
                        CurveStyle::line,
                        {},
                        {},
                        Colour::grey},
                       {"reproduced by the modes",
                        b.frequency_hz,
                        b.amplitude.cwiseMax(1e-6 * peak),
                        CurveStyle::dashed,
                        {},
                        {},
                        Colour::blue}};
    spectrum.x_axis.range = {0, found.band_hz.second};
    spectrum.y_axis.range = {1e-5 * peak, 2 * peak};
    figure.panels.push_back(std::move(motion));
    figure.panels.push_back(std::move(spectrum));
  }
  return figure;
}

Figure singular_values(const RecordModes& found, const std::string& suffix) {
  const Index count =
      std::min<Index>(found.search.singular_values.size(), 2 * found.search.orders.back().order);
  const VectorXd relative = found.search.singular_values.head(count) / found.search.singular_values[0];
  Panel panel{found.name, {"order"}, {"singular value of the Hankel matrix, relative", true}, {}};
  panel.curves = {{"",
                   VectorXd::LinSpaced(count, 1, static_cast<double>(count)),
                   relative.cwiseMax(1e-16),
                   CurveStyle::points,
                   {},
                   {},
                   Colour::blue}};
  panel.legend = Legend::none;
  return {"singular_values" + suffix, {panel}};
}

}  // namespace

std::vector<Figure> figures(const RecordModes& found, const std::string& suffix) {
  std::vector<Figure> result;
  if (!found.mode_by_mode) result.push_back(diagram(found, suffix));
  if (found.reproduced.size() > 0) result.push_back(reproduction(found, suffix));
  if (found.search.singular_values.size() > 0) result.push_back(singular_values(found, suffix));
  return result;
}

}  // namespace beamid::experiments
