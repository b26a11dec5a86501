// Extended Kalman filter; the equations: filters/algorithms/extended_kalman.hpp.
#include "filters/algorithms/registered_filter.hpp"

namespace beamid::filters {
namespace {

template <int N, int P>
std::unique_ptr<Filter> extended_kalman(std::unique_ptr<DiscreteModel> model) {
  return std::make_unique<algorithms::RegisteredFilter<algorithms::ExtendedKalman<double, N, P>>>(
      std::move(model));
}

// Of one mode, K and C, with the sensor's bias or without it, seen by one or two channels, and of one that is
// tracked (7 states) the sizes are fixed at compile time, and products are unrolled.
template <int N>
std::unique_ptr<Filter> of_one_mode(std::unique_ptr<DiscreteModel> model) {
  const std::size_t outputs = model->output_labels().size();
  if (outputs == 1) return extended_kalman<N, 1>(std::move(model));
  if (outputs == 2) return extended_kalman<N, 2>(std::move(model));
  return extended_kalman<Eigen::Dynamic, Eigen::Dynamic>(std::move(model));
}

std::unique_ptr<Filter> make_ekf(std::unique_ptr<DiscreteModel> model, const Options&) {
  const std::size_t states = model ? model->state_labels().size() : 0;
  if (states == 4) return of_one_mode<4>(std::move(model));
  if (states == 5) return of_one_mode<5>(std::move(model));
  if (states == 7) return of_one_mode<7>(std::move(model));
  return extended_kalman<Eigen::Dynamic, Eigen::Dynamic>(std::move(model));
}

const bool ekf_registered =
    filter_registry().add({"ekf",
                           "extended Kalman filter, Joseph update",
                           "[jazwinski1970], [bucy1968]",
                           {},
                           {contract::exact_on_linear_gaussian, contract::consistent, contract::identifies},
                           make_ekf});

}  // namespace
}  // namespace beamid::filters
