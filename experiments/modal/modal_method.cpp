#include "experiments/modal/modal_method.hpp"

#include <stdexcept>

namespace beamid::experiments {

std::vector<OrderPoles> ModalMethod::search_responses(const Eigen::VectorXd&, const Eigen::MatrixXcd&, double,
                                                      int) const {
  throw std::invalid_argument("this modal method does not work on frequency responses");
}

ModalMethodRegistry& modal_method_registry() {
  static ModalMethodRegistry registry("modal method");
  return registry;
}

}  // namespace beamid::experiments
