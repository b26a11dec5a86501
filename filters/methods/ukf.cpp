// Unscented Kalman filter, scaled; the equations: filters/algorithms/sigma_points.hpp and
// unscented_kalman.hpp. Options that break the covariance's positivity are refused, and so are points so
// close that rounding of f is all that their differences hold.
#include "filters/algorithms/registered_filter.hpp"
#include "filters/algorithms/scaled_spread.hpp"

namespace beamid::filters {
namespace {

const bool ukf_registered = filter_registry().add(
    {"ukf",
     "unscented Kalman filter, weights exact by construction, Joseph-like update",
     "[julier2004], [julier2002], [wan2000]",
     algorithms::scaled_spread_options(),
     {contract::exact_on_linear_gaussian, contract::consistent, contract::identifies},
     [](std::unique_ptr<DiscreteModel> model, const Options& options) {
       const std::size_t states = model->state_labels().size();
       return std::make_unique<algorithms::RegisteredFilter<algorithms::DynamicUnscentedKalman>>(
           std::move(model), algorithms::scaled_spread("ukf", options, states));
     }});

}  // namespace
}  // namespace beamid::filters
