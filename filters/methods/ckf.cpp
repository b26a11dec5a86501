// Cubature Kalman filter: 2n points alike in weight, the spherical-radial rule of degree three
// [arasaratnam2009]; the equations: filters/algorithms/sigma_points.hpp and unscented_kalman.hpp.
#include "filters/algorithms/registered_filter.hpp"
#include "filters/algorithms/scaled_spread.hpp"

namespace beamid::filters {
namespace {

const bool ckf_registered = filter_registry().add(
    {"ckf",
     "cubature Kalman filter, Joseph-like update",
     "[arasaratnam2009]",
     {},
     {contract::exact_on_linear_gaussian, contract::consistent, contract::identifies},
     [](std::unique_ptr<DiscreteModel> model, const Options&) {
       const std::size_t states = model->state_labels().size();
       return std::make_unique<algorithms::RegisteredFilter<algorithms::DynamicUnscentedKalman>>(
           std::move(model), algorithms::cubature_spread(states));
     }});

}  // namespace
}  // namespace beamid::filters
