#include "experiments/signal/chi_square_limit.hpp"

#include <boost/math/distributions/chi_squared.hpp>

namespace beamid::experiments {

double chi_square_limit(double freedom, double probability) {
  return quantile(boost::math::chi_squared(freedom), probability);
}

}  // namespace beamid::experiments
