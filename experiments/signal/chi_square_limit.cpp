#include "experiments/signal/chi_square_limit.hpp"

#include <boost/math/distributions/chi_squared.hpp>

namespace beamid::experiments {

double chi_square_limit(double freedom) {
  return quantile(boost::math::chi_squared(freedom), 0.95);
}

}  // namespace beamid::experiments
