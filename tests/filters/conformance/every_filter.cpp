#include "tests/filters/conformance/every_filter.hpp"

namespace beamid::test {

std::unique_ptr<filters::DiscreteModel> joint_model(int outputs, double dt, double noise) {
  return filters::discretise(std::make_shared<Oscillator>(mass, outputs), dt, "exponential",
                             {{}, noise * noise * Eigen::MatrixXd::Identity(outputs, outputs)});
}

void KnownOscillator::transition(const Eigen::VectorXd& z, const Eigen::VectorXd& u, Eigen::VectorXd& next) {
  joint_->transition(whole(z), u, value_);
  next = value_.head(2);
}

void KnownOscillator::linearised_transition(const Eigen::VectorXd& z, const Eigen::VectorXd& u,
                                            Eigen::VectorXd& next, Eigen::MatrixXd& jacobian) {
  joint_->linearised_transition(whole(z), u, value_, tangent_);
  next = value_.head(2);
  jacobian = tangent_.topLeftCorner(2, 2);
}

void KnownOscillator::output(const Eigen::VectorXd& z, const Eigen::VectorXd& u, Eigen::VectorXd& y) {
  joint_->output(whole(z), u, y);
}

void KnownOscillator::output_jacobian(const Eigen::VectorXd& z, const Eigen::VectorXd& u,
                                      Eigen::MatrixXd& jacobian) {
  joint_->output_jacobian(whole(z), u, tangent_);
  jacobian = tangent_.leftCols(2);
}

Eigen::VectorXd KnownOscillator::whole(const Eigen::VectorXd& z) {
  return Eigen::Vector4d(z[0], z[1], stiffness, damping);
}

filters::Measurements decay(int outputs, Eigen::Index samples, double dt, double noise, std::mt19937& random,
                            double x0) {
  const auto model = joint_model(outputs, dt, 1.0);
  std::normal_distribution<double> normal;
  filters::Measurements record{Eigen::VectorXd(samples), Eigen::MatrixXd(outputs, samples), {}};
  Eigen::VectorXd z = Eigen::Vector4d(x0, 0.0, stiffness, damping), next;
  for (Eigen::Index k = 0; k < samples; ++k) {
    record.time[k] = static_cast<double>(k) * dt;
    for (Eigen::Index i = 0; i < outputs; ++i) record.outputs(i, k) = z[i] + noise * normal(random);
    model->transition(z, {}, next);
    z.swap(next);
  }
  return record;
}

std::unique_ptr<filters::Filter> EveryFilter::make(std::unique_ptr<filters::DiscreteModel> model,
                                                   const filters::Options& options) {
  return filters::filter_registry().make(GetParam(), options, std::move(model));
}

bool EveryFilter::declares(const char* contract) {
  return filters::filter_registry().find(GetParam()).contracts.contains(contract);
}

std::unique_ptr<filters::Filter> EveryFilter::oscillator(int outputs, double dt, double noise) {
  if (linear_only()) return make(std::make_unique<KnownOscillator>(outputs, dt, noise));
  return make(joint_model(outputs, dt, noise));
}

filters::Gaussian EveryFilter::start(const Eigen::Vector4d& mean, const Eigen::Vector4d& variance) {
  const Eigen::Index n = linear_only() ? 2 : 4;
  return {mean.head(n), Eigen::MatrixXd(variance.head(n).asDiagonal())};
}

}  // namespace beamid::test
