#include "experiments/signal/chi_square_limit.hpp"

#include <boost/math/distributions/chi_squared.hpp>

#include "experiments/signal/in_double.hpp"

namespace beamid::experiments {

double chi_square_limit(double freedom, double probability) {
  return quantile(boost::math::chi_squared_distribution<double, InDouble>(freedom), probability);
}

}  // namespace beamid::experiments
