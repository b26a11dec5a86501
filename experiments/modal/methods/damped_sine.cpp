// Damped sines at the peaks of the spectrum, by nonlinear least squares [golub1973].
#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "experiments/modal/joint_decay_fit.hpp"
#include "experiments/modal/modal_method.hpp"
#include "experiments/modal/mode_by_mode.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd;

struct SineStart {
  Complex rate;
  double size;  ///< at the beginning; 0 where the mode cannot be isolated
};

/// Where a mode cannot be isolated, a damping rate of one decay over the record.
SineStart start_at(const MatrixXd& outputs, double interval, Complex peak, const std::vector<Complex>& all) {
  const double length = interval * static_cast<double>(outputs.cols());
  SineStart start{{-1 / length, peak.imag()}, 0};
  for (Index i = 0; i < outputs.rows(); ++i) {
    try {
      const IsolatedMode mode =
          isolate(outputs.row(i).transpose(), interval, peak.imag() / (2 * std::numbers::pi), all);
      const Complex rate = mode.rate();
      if (!(rate.real() < 0 && std::abs(rate - peak) < 0.1 * peak.imag())) continue;
      if (const double size = std::abs(mode.values[0]); size > start.size) start = {rate, size};
    } catch (const std::invalid_argument&) {  // too short for a kernel
    }
  }
  return start;
}

class DampedSines final : public ModalMethod {
 public:
  PoleSearch search(const MatrixXd& outputs, double interval, int) const override {
    PoleSearch found;
    found.decays = outputs;
    found.orders.push_back({0, {}});
    std::vector<Complex> peaks, rates;
    std::vector<SineStart> starts;
    for (const double f : spectral_peaks(outputs, interval)) peaks.emplace_back(0, 2 * std::numbers::pi * f);
    for (const Complex& peak : peaks) starts.push_back(start_at(outputs, interval, peak, peaks));
    const auto refuse = [&](Complex rate, const char* reason) {
      found.refused.push_back({{rate, Eigen::VectorXcd::Ones(outputs.rows())}, reason});
    };
    while (!starts.empty()) {
      rates.clear();
      for (const SineStart& start : starts) rates.push_back(start.rate);
      try {
        take(fit_decays_jointly(outputs, interval, rates), found);
        break;
      } catch (const std::runtime_error&) {
        const auto weakest =
            std::min_element(starts.begin(), starts.end(),
                             [](const SineStart& a, const SineStart& b) { return a.size < b.size; });
        refuse(weakest->rate, "least squares of all peaks do not converge with it");
        starts.erase(weakest);
      }
    }
    return found;
  }

 private:
  static void take(const JointDecayFit& fit, PoleSearch& found) {
    for (std::size_t m = 0; m < fit.rates.size(); ++m) {
      const auto at = static_cast<Index>(m);
      Pole pole{fit.rates[m], fit.shapes.col(at)};
      pole.take_deviations(fit.covariance.block<2, 2>(2 * at, 2 * at));
      if (pole.damping_ratio() > pole.damping_ratio_deviation)
        found.orders.back().poles.push_back(std::move(pole));
      else
        found.refused.push_back({pole, "damping ratio smaller than its standard deviation"});
    }
  }
};

const bool damped_sine_registered = modal_method_registry().add(
    {"damped_sine",
     "damped sines at the peaks of the spectrum, all together by least squares, for free decays",
     "[golub1973]",
     {},
     {contract::free_decay, contract::mode_by_mode},
     [](const filters::Options&) { return std::make_unique<DampedSines>(); }});

}  // namespace
}  // namespace beamid::experiments
