// The generalised-alpha method [chung1993]: second order, and of all such methods with a given damping of
// motions far too fast for the interval the one that damps slow motions least. One step multiplies the fast
// ones by rho_infinity.
#include "fem/response/one_step.hpp"

namespace beamid::fem {
namespace {

Response generalised_alpha(const ResponseProblem& problem, const ResponseOptions& options) {
  require_option("generalised_alpha", options, "rho_infinity", 0.0, 1.0, "0 to 1");
  const double rho = options.at("rho_infinity");
  const double alpha_m = (2.0 * rho - 1.0) / (rho + 1.0), alpha_f = rho / (rho + 1.0),
               shift = 1.0 - alpha_m + alpha_f;
  return integrate(problem, {"generalised_alpha", alpha_m, alpha_f, 0.25 * shift * shift, shift - 0.5});
}

const bool generalised_alpha_registered = register_response_method(
    {"generalised_alpha",
     "second order, fast motions multiplied by rho_infinity at each step, slow ones almost undamped",
     "[chung1993]",
     {{"rho_infinity", 0.8, "", "0 (fast motions gone in one step) to 1 (not damped)"}}},
    generalised_alpha);

}  // namespace
}  // namespace beamid::fem
