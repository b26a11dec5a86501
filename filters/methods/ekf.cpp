// Extended Kalman filter [jazwinski1970]:
//
//     predict   m = F(m, u),            P = J P J^T + Q                    J = dF/dz at the filtered mean
//     correct   S = H P H^T + R,        G = P H^T S^-1                     H = dh/dz at the predicted mean
//               m += G (y - h(m, u)),   P = (I - G H) P (I - G H)^T + G R G^T
//
// The last line is Joseph's form [bucy1968]: symmetric and positive for any gain, rounding included.
#include "filters/covariance_factor.hpp"
#include "filters/filter.hpp"
#include "filters/innovation.hpp"

namespace beamid::filters {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

class ExtendedKalmanFilter final : public Filter {
 public:
  explicit ExtendedKalmanFilter(std::unique_ptr<DiscreteModel> model) : Filter(std::move(model)) {}

  void reset(const Gaussian& belief) override {
    check_belief(belief, model_);
    belief_ = belief;
    if (belief.factor.size() > 0) belief_ = {belief.mean, with_covariance(belief).covariance};
  }

  void predict(const VectorXd& input) override {
    model_.linearised_transition(belief_.mean, input, next_, tangent_);
    belief_.mean.swap(next_);
    work_.noalias() = tangent_ * belief_.covariance;
    belief_.covariance.noalias() = work_ * tangent_.transpose();
    if (model_.process_noise().size() > 0) belief_.covariance += model_.process_noise();
    check_finite(belief_);
  }

  void take_in(const VectorXd& output, const VectorXd& input) override {
    model_.output(belief_.mean, input, expected_);
    model_.output_jacobian(belief_.mean, input, sensor_);
    correction_.innovation = output - expected_;
    cross_.noalias() = belief_.covariance * sensor_.transpose();
    correction_.innovation_covariance.noalias() = sensor_ * cross_;
    correction_.innovation_covariance += model_.output_noise();
    gain_ = weigh(correction_, cross_, factor_);

    belief_.mean.noalias() += gain_ * correction_.innovation;
    kept_.noalias() = -gain_ * sensor_;
    kept_.diagonal().array() += 1.0;
    work_.noalias() = kept_ * belief_.covariance;
    belief_.covariance.noalias() = work_ * kept_.transpose();
    noise_.noalias() = gain_ * model_.output_noise();
    belief_.covariance.noalias() += noise_ * gain_.transpose();
    symmetrise(belief_.covariance);
    check_finite(belief_);
  }

  const Gaussian& belief() const override { return belief_; }

 private:
  Gaussian belief_;
  VectorXd next_, expected_;
  MatrixXd tangent_, sensor_, cross_, gain_, kept_, noise_, work_;
  Eigen::LLT<MatrixXd> factor_;
};

const bool registered =
    filter_registry().add({"ekf",
                           "extended Kalman filter, Joseph update",
                           "[jazwinski1970], [bucy1968]",
                           {},
                           {contract::exact_on_linear_gaussian, contract::consistent},
                           [](std::unique_ptr<DiscreteModel> model, const Options&) {
                             return std::make_unique<ExtendedKalmanFilter>(std::move(model));
                           }});

}  // namespace
}  // namespace beamid::filters
