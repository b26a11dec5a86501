#include "experiments/signal/chi_square_limit.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "experiments/signal/in_double.hpp"

namespace beamid::experiments {

double chi_square_limit(double freedom, double probability) {
  return quantile(boost::math::chi_squared_distribution<double, InDouble>(freedom), probability);
}

double student_factor(double freedom) {
  constexpr double point = 0.975, normal_point = 1.959963984540054,
                   least = 0.1;  // freedom, where the factor is 1e12; less overflows
  const boost::math::students_t_distribution<double, InDouble> law(std::max(least, freedom));
  return boost::math::quantile(law, point) / normal_point;
}

}  // namespace beamid::experiments
