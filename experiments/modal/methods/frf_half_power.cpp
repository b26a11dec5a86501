// Modes from the lines around each peak of the frequency responses of a hammer test [ewins2000].
#include <stdexcept>

#include "experiments/modal/hammer_response.hpp"
#include "experiments/modal/modal_method.hpp"

namespace beamid::experiments {
namespace {

class ResponsePeaks final : public ModalMethod {
 public:
  explicit ResponsePeaks(double smallest_peak) : smallest_peak_(smallest_peak) {}

  PoleSearch search(const Eigen::MatrixXd&, double, int) const override {
    throw std::invalid_argument(
        "frf_half_power needs a measured force; half_power takes a record without one");
  }

  std::vector<OrderPoles> search_responses(const Eigen::VectorXd& frequency_hz,
                                           const Eigen::MatrixXcd& responses, double shift,
                                           int) const override {
    // The quantity is not told here; it only tilts the peaks, and the background takes it in.
    return {{0, poles_at_peaks(frequency_hz, responses, shift, 2, smallest_peak_)}};
  }

 private:
  double smallest_peak_;
};

const bool frf_half_power_registered = modal_method_registry().add(
    {"frf_half_power",
     "each mode from the lines above half of its peak's power in hammer hits' responses; needs a force",
     "[ewins2000]",
     {{"estimator", std::string("h1"), "", "h1: noise in the response; h2: noise in the force"},
      {"window_end", 0.001, "", "the value of the exponential window at the end of a hit; 1: no window"},
      {"smallest_peak", 0.05, "", "of the mobility, over the largest"}},
     {contract::frequency_response, contract::mode_by_mode},
     [](const filters::Options& options) {
       if (const std::string& word = options.text("estimator"); word != "h1" && word != "h2")
         throw std::invalid_argument("frf_half_power: estimator is '" + word + "'; expected h1 or h2");
       return std::make_unique<ResponsePeaks>(options.number("smallest_peak"));
     }});

}  // namespace
}  // namespace beamid::experiments
