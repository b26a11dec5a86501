// Extended Kalman filter; the equations: filters/algorithms/extended_kalman.hpp.
#include "filters/algorithms/registered_filter.hpp"

namespace beamid::filters {
namespace {

const bool ekf_registered = filter_registry().add(
    {"ekf",
     "extended Kalman filter, Joseph update",
     "[jazwinski1970], [bucy1968]",
     {},
     {contract::exact_on_linear_gaussian, contract::consistent, contract::identifies},
     [](std::unique_ptr<DiscreteModel> model, const Options&) {
       return std::make_unique<algorithms::RegisteredFilter<algorithms::DynamicExtendedKalman>>(
           std::move(model));
     }});

}  // namespace
}  // namespace beamid::filters
