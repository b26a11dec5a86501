// Square-root unscented Kalman filter, scaled; the equations: filters/algorithms/sigma_points.hpp and
// square_root_kalman.hpp.
#include "filters/algorithms/registered_filter.hpp"
#include "filters/algorithms/scaled_spread.hpp"

namespace beamid::filters {
namespace {

const bool srukf_registered = filter_registry().add(
    {"srukf",
     "square-root unscented Kalman filter, covariance positive by construction",
     "[vandermerwe2001]",
     algorithms::scaled_spread_options(),
     {contract::exact_on_linear_gaussian, contract::consistent, contract::identifies},
     [](std::unique_ptr<DiscreteModel> model, const Options& options) {
       const std::size_t states = model->state_labels().size();
       return std::make_unique<algorithms::RegisteredFilter<algorithms::DynamicSquareRootKalman>>(
           std::move(model), algorithms::scaled_spread("srukf", options, states));
     }});

}  // namespace
}  // namespace beamid::filters
