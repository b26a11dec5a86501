// Newmark's method [newmark1959]. Average acceleration, beta = 1/4 and gamma = 1/2, keeps the energy of an
// undamped structure and never becomes unstable; it takes every frequency omega for (2/h) atan(omega h / 2),
// and modes beyond pi/h for one near the sampling's own limit, undamped.
#include "fem/response/one_step.hpp"

namespace beamid::fem {
namespace {

Response newmark(const ResponseProblem& problem, const ResponseOptions& options) {
  require_option("newmark", options, "beta", 0.0, 1.0, "0 to 1");
  require_option("newmark", options, "gamma", 0.5, 1.0, "0.5 to 1: below it motions grow");
  return integrate(problem, {"newmark", 0.0, 0.0, options.at("beta"), options.at("gamma")});
}

const bool newmark_registered = register_response_method(
    {"newmark",
     "average acceleration: second order, no numerical damping",
     "[newmark1959]",
     {{"beta", 0.25, "",
       "weight of the new acceleration in the displacement; stable at any interval from gamma/2 on"},
      {"gamma", 0.5, "",
       "weight of the new acceleration in the velocity; above 1/2 it damps, at first order"}}},
    newmark);

}  // namespace
}  // namespace beamid::fem
