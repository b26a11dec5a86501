#include "experiments/identify/posterior/modal_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

ModalLikelihood::ModalLikelihood(const ModalResidual& residual) : residual_(residual) {
  const AskedParameters& asked = residual.model().asked();
  for (std::size_t j = 0; j < asked.unknowns.size(); ++j)
    priors_.emplace_back(asked.unknowns[j], asked.unknowns[j].quantity != "axial_load", asked.has_prior[j]);
  const double half_log = 0.5 * std::log(2.0 * std::numbers::pi);
  const std::vector<MeasuredMode>& modes = residual.data().modes;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    constant_ -= half_log + std::log(residual.frequency_deviation(i));
    if (modes[i].shape.size() > 1)
      constant_ -= static_cast<double>(modes[i].shape.size() - 1) *
                   (half_log + std::log(residual.shape_deviation(i) / modes[i].shape.norm()));
  }
}

LikelihoodValue ModalLikelihood::at(const VectorXd& u, bool slopes) const {
  LikelihoodValue result;
  try {
    const SearchSpace& space = residual_.space();
    const VectorXd x = space.place(physical(u));
    const ModalResidual::Value value = residual_.at(x, slopes);
    const Index rows = residual_.measured();
    result.log = constant_ - 0.5 * value.residual.head(rows).squaredNorm();
    if (std::isnan(result.log)) return {};
    if (!slopes) return result;
    const MatrixXd jacobian =
        value.jacobian.topRows(rows) * slope(u).cwiseQuotient(space.slope(x)).asDiagonal();
    result.gradient = -jacobian.transpose() * value.residual.head(rows);
    result.information = jacobian.transpose() * jacobian;
    if (!result.gradient.allFinite() || !result.information.allFinite()) return {};
  } catch (const std::runtime_error&) {  // no such modes: a structure that has buckled
    return {};
  }
  return result;
}

}  // namespace beamid::experiments
