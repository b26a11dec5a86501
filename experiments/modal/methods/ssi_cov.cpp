// Covariance-driven stochastic subspace identification [peeters1999] with uncertainties [doehler2013].
#include "experiments/modal/modal_method.hpp"
#include "experiments/modal/subspace_realisation.hpp"
#include "filters/whole_number.hpp"

namespace beamid::experiments {
namespace {

class StochasticMethod final : public ModalMethod {
 public:
  explicit StochasticMethod(const StochasticSettings& settings) : settings_(settings) {}

  PoleSearch search(const Eigen::MatrixXd& outputs, double interval, int largest_order) const override {
    StochasticSubspace found = stochastic_subspace(outputs, interval, largest_order, settings_);
    return {std::move(found.orders), std::move(found.singular_values), std::move(found.autocorrelations)};
  }

 private:
  StochasticSettings settings_;
};

const bool ssi_cov_registered = modal_method_registry().add(
    {"ssi_cov",
     "stochastic subspace identification from correlations, for random vibration, with standard deviations",
     "[peeters1999], [reynders2008], [doehler2013]",
     {{"rows", 0.0, "", "block rows of the Hankel matrix; 0: 100 in all, at most a hundredth of the samples"},
      {"segments", 50.0, "", "parts of the record whose scatter gives the standard deviations"}},
     {},
     [](const filters::Options& options) {
       StochasticSettings settings;
       settings.rows = filters::whole_number(options.number("rows"), 0, "ssi_cov", "rows");
       settings.segments = filters::whole_number(options.number("segments"), 2, "ssi_cov", "segments");
       return std::make_unique<StochasticMethod>(settings);
     }});

}  // namespace
}  // namespace beamid::experiments
