#include "experiments/modal/envelope_line.hpp"

#include <algorithm>
#include <cmath>

namespace beamid::experiments {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::VectorXd, Eigen::VectorXcd;

EnvelopeLine line_through(const VectorXd& time, const VectorXcd& logarithm, double independent_share) {
  const VectorXd weight = (2 * (logarithm.real().array() - logarithm.real().maxCoeff())).exp();
  const double sum = weight.sum();
  EnvelopeLine line;
  line.time = weight.dot(time) / sum;
  const Complex mean = (weight.cast<Complex>().array() * logarithm.array()).sum() / sum;
  line.log_amplitude = mean.real();
  const VectorXd from_mean = time.array() - line.time;
  const double moment = (weight.array() * from_mean.array().square()).sum();
  line.slope = ((weight.array() * from_mean.array()).cast<Complex>() * logarithm.array()).sum() / moment;
  const VectorXcd left = logarithm.array() - mean - line.slope * from_mean.array().cast<Complex>();
  const double count = static_cast<double>(time.size());
  const double independent = std::max(count * independent_share, 2.5);  // two go into the line
  const double variance =
      (weight.array() * left.array().abs2()).sum() / (2 * count) * independent / (independent - 2);
  line.deviation = std::sqrt(variance / (independent_share * moment));
  return line;
}

VectorXcd unwrapped_logarithm(const VectorXcd& z) {
  VectorXcd logarithm(z.size());
  double turned = 0;
  for (Index m = 0; m < z.size(); ++m) {
    turned += std::arg(m > 0 ? z[m] * std::conj(z[m - 1]) : z[m]);
    logarithm[m] = {std::log(std::max(std::abs(z[m]), 1e-300)), turned};
  }
  return logarithm;
}

}  // namespace beamid::experiments
