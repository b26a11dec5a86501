#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "experiments/results/figure.hpp"
#include "experiments/signal/spectrum.hpp"
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

/// Where the channels stand in a sketch: at their positions along the beam, or one after the other.
VectorXd sketched_places(const std::vector<Channel>& channels) {
  const auto count = static_cast<Index>(channels.size());
  VectorXd places = VectorXd::LinSpaced(count, 0.0, 1.0);
  const bool stated = std::all_of(channels.begin(), channels.end(),
                                  [](const Channel& channel) { return channel.position.has_value(); });
  if (!stated) return places;
  for (Index i = 0; i < count; ++i) places[i] = *channels[static_cast<std::size_t>(i)].position;
  return places.maxCoeff() > places.minCoeff() ? places : VectorXd::LinSpaced(count, 0.0, 1.0);
}

/// Whether shapes of these channels can be drawn as one moving line.
bool are_alike(const std::vector<Channel>& channels) {
  return std::all_of(channels.begin(), channels.end(), [&](const Channel& channel) {
    return channel.quantity == channels.front().quantity && channel.quantity != Quantity::strain;
  });
}

Figure diagram(const RecordModes& found, const std::string& suffix) {
  Panel panel{found.name, {"frequency [Hz]"}, {"model order"}};
  const double top = found.search.orders.empty() ? 2 : found.search.orders.back().order + 1;
  VectorXd frequency;
  const VectorXd spectrum = joint_spectrum(found.target, found.interval, frequency);
  const VectorXd decibels = spectrum.cwiseMax(1e-300).array().log10();
  const double peak = decibels.maxCoeff(), floor = std::max(decibels.minCoeff(), peak - 4);
  panel.line("spectrum", frequency, (top * (decibels.array() - floor) / (peak - floor)).cwiseMax(0).matrix(),
             Colour::grey);
  panel.curves.back().style = CurveStyle::thin;
  panel.across(found.band_hz.first, found.band_hz.second).up(0, top);
  for (const ModeEstimate& mode : found.modes)  // behind the poles that they are chosen from
    panel.upright(&mode == &found.modes.front() ? "mode" : "", mode.pole.frequency_hz(), Colour::vermillion);
  add_channels(panel, found.record.channels);
  add_poles(panel, found.stabilisation.poles, Stability::unstable, "not stable");
  add_poles(panel, found.stabilisation.poles, Stability::frequency, "stable in frequency");
  add_poles(panel, found.stabilisation.poles, Stability::full, "stable");
  Figure figure{"stabilisation" + suffix, {panel}, 1, 1, 900, 520};
  figure.caption =
      "Stabilisation diagram: poles by model order, the modes chosen, and behind them the spectrum "
      "(logarithmic, four decades at most).";
  return figure;
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
    const std::string label = what + " [" + modal_study_unit_of(found, i) + "]";
    Panel motion = reproduction_panel(channel.name, time, measured,
                                      {{"reproduced by the modes", again, Colour::sky}}, label);
    if (!found.free_decay) motion.x_axis.label = "lag [s]";
    Panel spectrum = spectrum_panel({{"measured", measured, Colour::black},
                                     {"reproduced by the modes", again, Colour::sky}},
                                    found.interval, label, 5)
                         .value_or(Panel{"", {"frequency [Hz]"}, {"no motion"}});
    if (spectrum.curves.size() == 2) {
      std::swap(spectrum.curves[0], spectrum.curves[1]);  // the record in front, as beside it
      spectrum.curves[1].style = CurveStyle::thin;
    }
    spectrum.across(0, found.band_hz.second);
    figure.panels.push_back(thinned(std::move(motion)));
    figure.panels.push_back(thinned(std::move(spectrum)));
  }
  figure.caption = "The record and what the modes make of it, in time and as amplitude spectra.";
  return figure;
}

Figure singular_values(const RecordModes& found, const std::string& suffix) {
  const Index count =
      std::min<Index>(found.search.singular_values.size(), Index{2} * found.search.orders.back().order);
  const VectorXd relative = found.search.singular_values.head(count) / found.search.singular_values[0];
  Figure figure{"singular_values" + suffix,
                {Panel{found.name, {"order"}, {"singular value of the Hankel matrix, relative", true}}
                     .points("", VectorXd::LinSpaced(count, 1, static_cast<double>(count)),
                             relative.cwiseMax(1e-16), Colour::blue)
                     .key(Legend::none)}};
  figure.caption =
      "Singular values of the Hankel matrix: two for each mode stand above the slope of the noise.";
  return figure;
}

}  // namespace

void add_poles(Panel& panel, const std::vector<DiagramPole>& poles, Stability stability,
               const std::string& label) {
  std::vector<double> frequency, order, damping, frequency_deviation, damping_deviation;
  std::vector<Eigen::VectorXcd> shapes;
  for (const DiagramPole& one : poles) {
    if (one.stability != stability) continue;
    frequency.push_back(one.pole.frequency_hz());
    order.push_back(one.order);
    damping.push_back(100.0 * one.pole.damping_ratio());
    frequency_deviation.push_back(one.pole.frequency_deviation_hz);
    damping_deviation.push_back(100.0 * one.pole.damping_ratio_deviation);
    shapes.push_back(one.pole.shape);
    Index largest = 0;  // which is turned to be real, as of the modes
    if (one.pole.shape.size() > 0 && one.pole.shape.cwiseAbs().maxCoeff(&largest) > 0.0)
      shapes.back() /= one.pole.shape[largest];
  }
  if (frequency.empty()) return;
  const bool full = stability == Stability::full;
  panel.add(full ? CurveStyle::points : CurveStyle::open_points, label, of(frequency), of(order),
            full                                ? Colour::blue
            : stability == Stability::frequency ? Colour::orange
                                                : Colour::grey);
  Curve& curve = panel.curves.back();
  curve.facts.push_back({"damping ratio [%]", of(damping)});
  const auto is_known = [](double deviation) { return deviation > 0.0 && std::isfinite(deviation); };
  if (std::any_of(frequency_deviation.begin(), frequency_deviation.end(), is_known)) {
    curve.facts.push_back({"standard deviation of the frequency [Hz]", of(frequency_deviation)});
    curve.facts.push_back({"standard deviation of the damping ratio [%]", of(damping_deviation)});
  }
  const auto channels = static_cast<Index>(panel.channels.size());
  if (channels < 2 || std::any_of(shapes.begin(), shapes.end(), [&](const Eigen::VectorXcd& shape) {
        return shape.size() != channels || !shape.allFinite();
      }))
    return;
  curve.shapes.resize(channels, static_cast<Index>(shapes.size()));
  for (std::size_t k = 0; k < shapes.size(); ++k) curve.shapes.col(static_cast<Index>(k)) = shapes[k];
}

void add_channels(Panel& panel, const std::vector<Channel>& channels) {
  for (const Channel& channel : channels)
    panel.channels.push_back(channel.name.empty() ? to_string(channel.quantity) : channel.name);
  if (channels.size() < 2 || !are_alike(channels)) return;
  const VectorXd places = sketched_places(channels);
  panel.places = (places.array() - places.minCoeff()) / (places.maxCoeff() - places.minCoeff());
}

std::optional<NodalModes> measured_shapes(const RecordModes& found) {
  const std::vector<Channel>& channels = found.record.channels;
  const auto count = static_cast<Index>(channels.size());
  if (count < 2 || found.modes.empty() || !are_alike(channels)) return std::nullopt;
  NodalModes modes{found.name, Eigen::Matrix3Xd::Zero(3, count), {}, {}, true};
  modes.places.row(0) = sketched_places(channels).transpose();
  for (const ModeEstimate& mode : found.modes) {
    if (mode.pole.shape.size() != count) return std::nullopt;
    NodalModes::Mode one{mode.pole.frequency_hz(), mode.pole.damping_ratio(), {}, {}, {}};
    if (mode.pole.frequency_deviation_hz > 0.0) one.frequency_deviation_hz = mode.pole.frequency_deviation_hz;
    // Turned so that the largest component is real, which leaves in quadrature what does not move in phase.
    Index largest = 0;
    mode.pole.shape.cwiseAbs().maxCoeff(&largest);
    one.shape = Eigen::Matrix3Xcd::Zero(3, count);
    one.shape.row(2) = (mode.pole.shape / mode.pole.shape[largest]).transpose();
    modes.modes.push_back(std::move(one));
  }
  std::vector<int> order(channels.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return modes.places(0, a) < modes.places(0, b); });
  for (std::size_t i = 0; i + 1 < order.size(); ++i) modes.lines.emplace_back(order[i], order[i + 1]);
  return modes;
}

SwingModel swing_model(const NodalModes& modes) {
  SwingModel model;
  SwingModel::Part nodes{SwingModel::Kind::points, modes.places, {}, {}};
  for (unsigned i = 0; i < modes.places.cols(); ++i) nodes.corners.push_back(i);
  for (const NodalModes::Mode& mode : modes.modes) {
    const auto motion = static_cast<int>(nodes.motion.size());
    model.modes.push_back({fmt::format("mode {}, {:.5g} Hz", model.modes.size() + 1, mode.frequency_hz),
                           mode.frequency_hz, mode.damping_ratio, motion, motion + 1});
    nodes.motion.emplace_back(mode.shape.real());
    nodes.motion.emplace_back(mode.shape.imag());
  }
  SwingModel::Part lines = nodes;
  lines.kind = SwingModel::Kind::lines;
  lines.corners.clear();
  for (const auto& [from, to] : modes.lines)
    lines.corners.insert(lines.corners.end(), {static_cast<unsigned>(from), static_cast<unsigned>(to)});
  model.parts = {std::move(lines), std::move(nodes)};
  return model;
}

std::vector<Figure> figures(const RecordModes& found, const std::string& suffix) {
  std::vector<Figure> result;
  if (!found.mode_by_mode) result.push_back(diagram(found, suffix));
  if (found.reproduced.size() > 0) result.push_back(reproduction(found, suffix));
  if (found.search.singular_values.size() > 0) result.push_back(singular_values(found, suffix));
  return result;
}

}  // namespace beamid::experiments
