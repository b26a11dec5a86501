// Square-root cubature Kalman filter [arasaratnam2009, sec. VII]; the equations:
// filters/algorithms/sigma_points.hpp and square_root_kalman.hpp.
#include "filters/algorithms/registered_filter.hpp"
#include "filters/algorithms/scaled_spread.hpp"

namespace beamid::filters {
namespace {

const bool srckf_registered = filter_registry().add(
    {"srckf",
     "square-root cubature Kalman filter, covariance positive by construction",
     "[arasaratnam2009]",
     {},
     {contract::exact_on_linear_gaussian, contract::consistent, contract::identifies},
     [](std::unique_ptr<DiscreteModel> model, const Options&) {
       const std::size_t states = model->state_labels().size();
       return std::make_unique<algorithms::RegisteredFilter<algorithms::DynamicSquareRootKalman>>(
           std::move(model), algorithms::cubature_spread(states));
     }});

}  // namespace
}  // namespace beamid::filters
