// Bayes' fast Fourier method, a mode or a close pair in each band, for random vibration [au2011].
#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/gamma.hpp>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "experiments/modal/ambient_mode.hpp"
#include "experiments/modal/ambient_pair.hpp"
#include "experiments/modal/modal_method.hpp"
#include "experiments/modal/mode_by_mode.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd;

// Autocorrelations of every channel (p x L), whose spectrum is smooth where that of the record is not.
MatrixXd autocorrelations(const MatrixXd& outputs, Index lags) {
  const Index count = outputs.cols() - lags;
  MatrixXd found(outputs.rows(), lags);
  for (Index i = 0; i < outputs.rows(); ++i) {
    const Eigen::VectorXd y = (outputs.row(i).array() - outputs.row(i).mean()).matrix();
    for (Index l = 0; l < lags; ++l)
      found(i, l) = y.head(count).dot(y.segment(l + 1, count)) / static_cast<double>(count);
  }
  return found;
}

// Neighbours as one range.
std::string lines_sentence(const AmbientMode& mode, Index in_band, std::vector<double> lines, double step) {
  std::sort(lines.begin(), lines.end());
  std::string text;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t first = i;
    while (i + 1 < lines.size() && lines[i + 1] - lines[i] < 3.5 * step) ++i;
    text += fmt::format("{}{:.5g}", text.empty() ? "" : ", ", lines[first]);
    if (i > first) text += fmt::format(" to {:.5g}", lines[i]);
  }
  return fmt::format(
      "At {} Hz, beside the mode at {:.5g} Hz, the record is stronger than this mode and noise can be: a "
      "machine, or another mode. {} of the {} frequencies of its band were excluded.",
      text, mode.frequency_hz, static_cast<Index>(3 * lines.size()), in_band);
}

constexpr double most_dispersed =
    10.0;  // of a band: one for its mode, 4 to 5 where the load is not quite white

class BayesMethod final : public ModalMethod {
 public:
  BayesMethod(ResponseKind kind, double kappa, double first_ratio)
      : kind_(kind), kappa_(kappa), first_ratio_(first_ratio) {}

  PoleSearch search(const MatrixXd& outputs, double interval, int) const override {
    if (outputs.cols() < 400)
      throw std::invalid_argument(
          fmt::format("bayoma: {} samples; expected at least 400 of random vibration", outputs.cols()));
    PoleSearch found;
    found.orders.push_back({0, {}});
    found.decays = autocorrelations(outputs, std::clamp<Index>(outputs.cols() / 50, 50, 4000));
    const BandCoefficients all = fourier_coefficients(outputs, interval);
    const std::vector<double> peaks = spectral_peaks(found.decays, interval);
    const auto middle = [&](std::size_t i) {  // between peak i - 1 and peak i
      return i == 0 ? 0.0 : i < peaks.size() ? 0.5 * (peaks[i - 1] + peaks[i]) : 1e300;
    };
    for (std::size_t i = 0; i < peaks.size(); ++i) {
      if (i + 1 < peaks.size() && add_pair(all, {peaks[i], peaks[i + 1]}, {middle(i), middle(i + 2)}, found))
        ++i;
      else if (!add_pair(all, {peaks[i], peaks[i]}, {middle(i), middle(i + 1)}, found))
        add_mode(all, peaks[i], {middle(i), middle(i + 1)}, found);
    }
    return found;
  }

 private:
  // The band is as wide as the damping ratio asks for, which is known only then: twice.
  BandCoefficients fit(const BandCoefficients& all, const std::pair<double, double>& room,
                       AmbientMode& mode) const {
    BandCoefficients band;
    for (int pass = 0; pass < 3; ++pass) {
      const double half = kappa_ * mode.damping_ratio * mode.frequency_hz;
      band = within(all, {std::max(room.first, mode.frequency_hz - half),
                          std::min(room.second, mode.frequency_hz + half)});
      mode = ambient_mode(band, mode.frequency_hz, mode.damping_ratio, kind_);
      if (!mode.converged || !(mode.damping_ratio < 0.5) || mode.frequency_hz < mode.band_hz.first ||
          mode.frequency_hz > mode.band_hz.second)
        throw std::invalid_argument("the band has no likeliest mode");
    }
    return band;
  }

  /// Two modes of the band about two neighbouring peaks, or about one, where they explain it better than one
  /// does by more than chance makes of one in a hundred thousand, and each is determined.
  bool add_pair(const BandCoefficients& all, const std::pair<double, double>& peaks,
                const std::pair<double, double>& room, PoleSearch& found) const {
    constexpr double by_chance = 1e-5, determined = 0.5, widths_apart = 8.0;  // half widths
    const bool two_peaks = peaks.second > peaks.first;
    try {
      AmbientMode one;
      one.frequency_hz = 0.5 * (peaks.first + peaks.second);
      one.damping_ratio = std::max(first_ratio_, (peaks.second - peaks.first) / one.frequency_hz);
      if (one.damping_ratio > 0.1 ||
          (two_peaks && (peaks.second - peaks.first) > kappa_ * first_ratio_ * peaks.first))
        return false;
      BandCoefficients band;
      for (int pass = 0; pass < (two_peaks ? 1 : 2); ++pass) {
        const auto [lower, upper] = two_peaks ? peaks : std::pair(one.frequency_hz, one.frequency_hz);
        const double half = kappa_ * (two_peaks ? first_ratio_ : one.damping_ratio) * one.frequency_hz;
        band = within(all, {std::max(room.first, lower - half), std::min(room.second, upper + half)});
        one = ambient_mode(band, one.frequency_hz, one.damping_ratio, kind_);
        if (!(one.damping_ratio < 0.2) || one.frequency_hz < one.band_hz.first ||
            one.frequency_hz > one.band_hz.second)
          return false;
      }
      std::vector<std::pair<double, double>> starts;
      if (two_peaks) starts.push_back(peaks);
      const AmbientPair pair = ambient_pair(band, one, starts, kind_);
      const boost::math::chi_squared law(pair.more_parameters);
      if (!pair.converged || !separate(pair) || !(pair.gain > quantile(complement(law, by_chance))))
        return false;
      const double furthest = widths_apart * one.damping_ratio * one.frequency_hz;
      for (const AmbientMode& mode : pair.modes) {
        const double half_width = mode.damping_ratio * mode.frequency_hz;
        if (!(mode.damping_ratio_deviation < determined * mode.damping_ratio) ||
            !(mode.frequency_deviation_hz < determined * half_width) || half_width < all.frequency_hz[0] ||
            (!two_peaks && std::abs(mode.frequency_hz - one.frequency_hz) > furthest) ||
            mode.frequency_hz < one.band_hz.first || mode.frequency_hz > one.band_hz.second)
          return false;
      }
      for (const AmbientMode& mode : pair.modes) found.orders.back().poles.push_back(pole_of(mode));
      return true;
    } catch (const std::invalid_argument&) {
      return false;  // of one mode, add_mode() gives the reason
    }
  }

  /// Two modes at one frequency and of one shape, one a hundred times weaker, or moved by one force are a way
  /// to write a spectrum that is not quite that of one mode.
  static bool separate(const AmbientPair& pair) {
    constexpr double alike = 0.95, weak = 1e-3;
    const auto& [a, b] = pair.modes;
    const double apart = std::abs(b.frequency_hz - a.frequency_hz),
                 width = 0.5 * (a.damping_ratio * a.frequency_hz + b.damping_ratio * b.frequency_hz),
                 ratio = a.force_density / b.force_density;
    return pair.coherence < alike && ratio > weak && ratio < 1.0 / weak &&
           (apart > width || std::pow(a.shape.dot(b.shape), 2) < alike);
  }

  static Pole pole_of(const AmbientMode& mode) {
    const double w = 2.0 * std::numbers::pi * mode.frequency_hz, zeta = mode.damping_ratio;
    Pole pole{Complex(-zeta * w, w * std::sqrt(1.0 - zeta * zeta)), mode.shape.cast<Complex>()};
    pole.frequency_deviation_hz = mode.frequency_deviation_hz;
    pole.damping_ratio_deviation = mode.damping_ratio_deviation;
    return pole;
  }

  void add_mode(const BandCoefficients& all, double peak, const std::pair<double, double>& room,
                PoleSearch& found) const {
    Pole pole{Complex(0.0, 2.0 * std::numbers::pi * peak), Eigen::VectorXcd::Ones(all.coefficients.rows())};
    try {
      AmbientMode mode;
      mode.frequency_hz = peak, mode.damping_ratio = first_ratio_;
      BandCoefficients rest = all, band = fit(rest, room, mode);
      std::vector<double> lines;
      while (const std::optional<double> line = line_in(band, mode)) {
        lines.push_back(*line);
        rest = without(rest, *line);
        band = fit(rest, room, mode);
        if (static_cast<Index>(3 * lines.size()) > band.frequency_hz.size() / 3)
          throw std::invalid_argument("its band is not that of one mode: a machine, or other modes");
      }
      const double zeta = mode.damping_ratio;
      pole = pole_of(mode);
      if (!(mode.damping_ratio_deviation < mode.damping_ratio))
        throw std::invalid_argument(fmt::format("too uncertain, damping ratio {:.2g} %", 100.0 * zeta));
      const double step = all.frequency_hz[0];
      if (zeta * mode.frequency_hz < step)
        throw std::invalid_argument(
            "as narrow as so long a record shows: a machine, or a mode that needs a longer one");
      const auto peak_lines = static_cast<Index>(2.0 * zeta * mode.frequency_hz / step);
      const double dispersion =
          band_dispersion(band_misfit(mode, band, kind_), band.coefficients.rows(), peak_lines);
      if (dispersion > most_dispersed)
        throw std::invalid_argument(
            "its band is not that of one mode, nor of two: close modes, or a load that is not white; try "
            "ssi_cov");
      found.orders.back().poles.push_back(pole);
      if (!lines.empty())
        found.objections.emplace_back(
            "excluded_lines",
            lines_sentence(mode, within(all, mode.band_hz).frequency_hz.size(), lines, step));
    } catch (const std::invalid_argument& error) {
      found.refused.push_back({pole, error.what()});
    }
  }

  // Where the band is further from the mode, and from its own median around, than by chance in one of ten
  // thousand bands. What is left of a neighbour rises over many frequencies and is no line.
  std::optional<double> line_in(const BandCoefficients& band, const AmbientMode& mode) const {
    constexpr double by_chance = 1e-4;
    constexpr Index around = 25;
    const boost::math::gamma_distribution<> law(static_cast<double>(band.coefficients.rows()));
    Eigen::VectorXd misfit = band_misfit(mode, band, kind_);
    const Index n = misfit.size();
    const double limit = quantile(complement(law, by_chance / static_cast<double>(n)));
    for (Index at = 0; misfit.maxCoeff(&at) > limit; misfit[at] = 0.0) {
      const Index from = std::max<Index>(0, at - around), to = std::min(n, at + around + 1);
      const double level = median(Eigen::VectorXd(misfit.segment(from, to - from))) / quantile(law, 0.5);
      if (misfit[at] > limit * std::max(1.0, level)) return band.frequency_hz[at];
    }
    return {};
  }

  ResponseKind kind_;
  double kappa_, first_ratio_;
};

ResponseKind response_kind(const std::string& name) {
  if (name == "displacement") return ResponseKind::displacement;
  if (name == "velocity") return ResponseKind::velocity;
  if (name == "acceleration") return ResponseKind::acceleration;
  throw std::invalid_argument("bayoma: response is '" + name +
                              "'; expected displacement, velocity or acceleration");
}

const bool bayoma_registered = modal_method_registry().add(
    {"bayoma",
     "Bayes' fast Fourier method, one mode in each band or two close ones, for random vibration, with "
     "standard deviations",
     "[au2011], [au2017, ch. 13], [au2014]",
     {{"response", std::string("acceleration"), "",
       "what was measured: displacement, velocity, acceleration"},
      {"kappa", 10.0, "", "half width of a mode's band over damping ratio times frequency"},
      {"damping_ratio", 0.01, "", "to begin with"}},
     {contract::mode_by_mode},
     [](const filters::Options& options) {
       const double kappa = options.number("kappa"), ratio = options.number("damping_ratio");
       if (!(kappa >= 2.0 && kappa <= 100.0))
         throw std::invalid_argument(fmt::format("bayoma: kappa is {:g}; expected 2 to 100", kappa));
       if (!(ratio > 0.0 && ratio < 0.3))
         throw std::invalid_argument(
             fmt::format("bayoma: damping_ratio is {:g}; expected between 0 and 0.3", ratio));
       return std::make_unique<BayesMethod>(response_kind(options.text("response")), kappa, ratio);
     }});

}  // namespace
}  // namespace beamid::experiments
