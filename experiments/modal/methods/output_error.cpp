// Poles of the averaged responses to measured inputs, refined on all lines of the record [guillaume1998].
#include <stdexcept>

#include "experiments/modal/common_denominator.hpp"
#include "experiments/modal/modal_method.hpp"

namespace beamid::experiments {
namespace {

class OutputErrorMethod final : public ModalMethod {
 public:
  PoleSearch search(const Eigen::MatrixXd&, double, int) const override {
    throw std::invalid_argument("output_error needs a measured input; ssi_cov takes a record without one");
  }

  std::vector<OrderPoles> search_responses(const Eigen::VectorXd& frequency_hz,
                                           const Eigen::MatrixXcd& responses, double shift,
                                           int largest_order) const override {
    return common_denominator_poles(frequency_hz, responses, shift, largest_order);
  }
};

const bool output_error_registered = modal_method_registry().add(
    {"output_error",
     "poles of the responses to a moving base or forces that act all the time, refined on all lines",
     "[guillaume1998], [pintelon2012], [golub1973]",
     {},
     {contract::measured_input},
     [](const filters::Options&) { return std::make_unique<OutputErrorMethod>(); }});

}  // namespace
}  // namespace beamid::experiments
