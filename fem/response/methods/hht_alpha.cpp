// The method of Hilber, Hughes and Taylor [hilber1977]: second order, damps motions that the interval cannot
// follow.
#include "fem/response/one_step.hpp"

namespace beamid::fem {
namespace {

Response hht_alpha(const ResponseProblem& problem, const ResponseOptions& options) {
  require_option("hht_alpha", options, "alpha", -1.0 / 3.0 - 1e-12, 0.0, "-1/3 to 0");
  const double alpha = options.at("alpha");
  return integrate(problem, {"hht_alpha", 0.0, -alpha, 0.25 * (1.0 - alpha) * (1.0 - alpha), 0.5 - alpha});
}

const bool hht_alpha_registered =
    register_response_method({"hht_alpha",
                              "second order, damps what the interval cannot follow",
                              "[hilber1977]",
                              {{"alpha", -0.1, "", "-1/3 (most damping) to 0 (average acceleration)"}}},
                             hht_alpha);

}  // namespace
}  // namespace beamid::fem
