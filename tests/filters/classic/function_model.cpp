#include "tests/filters/classic/function_model.hpp"

namespace beamid::test {

std::vector<filters::Label> FunctionModel::output_labels() const {
  return std::vector<filters::Label>(r_.rows());
}

void FunctionModel::transition(const Eigen::VectorXd& z, const Eigen::VectorXd& u, Eigen::VectorXd& next) {
  next.resize(z.size());
  f_(z, u, next);
}

void FunctionModel::output(const Eigen::VectorXd& z, const Eigen::VectorXd& u, Eigen::VectorXd& y) {
  y.resize(r_.rows());
  h_(z, u, y);
}

}  // namespace beamid::test
