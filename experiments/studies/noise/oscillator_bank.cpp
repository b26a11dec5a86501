#include "experiments/studies/noise/oscillator_bank.hpp"

#include <cmath>
#include <complex>
#include <stdexcept>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::Matrix2d, Eigen::MatrixXd, Eigen::Vector2d, Eigen::VectorXd;

// e^(A dt), A = [0 1; -k -c]: e^(-c dt/2) (cos I + sin/w (A + c/2 I)), w^2 = k - c^2/4; where the filter's k
// and c do not oscillate, w is imaginary and the same formula holds.
Matrix2d moved(double k, double c, double dt) {
  const std::complex<double> w = std::sqrt(std::complex<double>(k - 0.25 * c * c));
  const double cosine = std::cos(w * dt).real();
  const double sine = std::abs(w * dt) < 1e-9 ? dt : (std::sin(w * dt) / w).real();
  Matrix2d a;
  a << 0.5 * c, 1.0, -k, -0.5 * c;
  return std::exp(-0.5 * c * dt) * (cosine * Matrix2d::Identity() + sine * a);
}

class Bank final : public filters::DiscreteModel {
 public:
  Bank(const std::vector<BankMember>& members, Quantity observed, double interval, double variance)
      : members_(members),
        observed_(observed),
        interval_(interval),
        count_(static_cast<Index>(members.size())),
        noise_(MatrixXd::Constant(1, 1, variance)) {
    for (const BankMember& m : members) {
      if (!(m.stiffness > 0.25 * m.damping * m.damping))
        throw std::invalid_argument("oscillator of stiffness " + std::to_string(m.stiffness) +
                                    " and damping " + std::to_string(m.damping) +
                                    " per unit of mass; expected one that oscillates");
      if (m.unknown && unknown_ < static_cast<Index>(&m - members.data()))
        throw std::invalid_argument("unknown oscillators must come before known ones");
      unknown_ += m.unknown ? 1 : 0;
    }
    process_.setZero(size(), size());
    for (Index i = 0; i < count_; ++i) {
      const BankMember& m = members[i];
      const Matrix2d p = m.shaped * m.shaped * Vector2d(1.0, m.stiffness).asDiagonal(),
                     f = moved(m.stiffness, m.damping, interval);
      process_.block<2, 2>(2 * i, 2 * i) = p - f * p * f.transpose();
    }
  }

  std::vector<filters::Label> state_labels() const override {
    std::vector<filters::Label> labels;
    for (Index i = 1; i <= count_; ++i) {
      labels.push_back({"displacement_" + std::to_string(i), "m"});
      labels.push_back({"velocity_" + std::to_string(i), "m/s"});
    }
    for (Index i = 1; i <= unknown_; ++i) {
      labels.push_back({"stiffness_" + std::to_string(i), "1/s2"});
      labels.push_back({"damping_" + std::to_string(i), "1/s"});
    }
    return labels;
  }
  std::vector<filters::Label> output_labels() const override {
    return {{to_string(observed_), si_unit(observed_)}};
  }
  const MatrixXd& process_noise() const override { return process_; }
  const MatrixXd& output_noise() const override { return noise_; }
  double interval() const override { return interval_; }

  void transition(const VectorXd& state, const VectorXd&, VectorXd& next) override {
    next = state;
    for (Index i = 0; i < count_; ++i)
      next.segment<2>(2 * i) =
          moved(stiffness(state, i), damping(state, i), interval_) * state.segment<2>(2 * i);
  }
  void linearised_transition(const VectorXd& state, const VectorXd& input, VectorXd& next,
                             MatrixXd& jacobian) override {
    transition(state, input, next);
    jacobian.setIdentity(size(), size());
    for (Index i = 0; i < count_; ++i) {
      const double k = stiffness(state, i), c = damping(state, i);
      jacobian.block<2, 2>(2 * i, 2 * i) = moved(k, c, interval_);
      if (i >= unknown_) continue;
      const double dk = 1e-5 * members_[i].stiffness, dc = 1e-5 * std::sqrt(members_[i].stiffness);
      const auto slope = [&](double a, double b, double step) -> Vector2d {
        return (moved(k + a, c + b, interval_) - moved(k - a, c - b, interval_)) * state.segment<2>(2 * i) /
               (2.0 * step);
      };
      jacobian.block<2, 1>(2 * i, 2 * count_ + 2 * i) = slope(dk, 0.0, dk);
      jacobian.block<2, 1>(2 * i, 2 * count_ + 2 * i + 1) = slope(0.0, dc, dc);
    }
  }
  void output(const VectorXd& state, const VectorXd&, VectorXd& output) override {
    output.setZero(1);
    for (Index i = 0; i < count_; ++i) {
      const double x = state[2 * i], v = state[2 * i + 1];
      output[0] += observed_ == Quantity::displacement ? x
                   : observed_ == Quantity::velocity   ? v
                                                       : -stiffness(state, i) * x - damping(state, i) * v;
    }
  }
  void output_jacobian(const VectorXd& state, const VectorXd&, MatrixXd& jacobian) override {
    jacobian.setZero(1, size());
    for (Index i = 0; i < count_; ++i) {
      if (observed_ == Quantity::displacement) jacobian(0, 2 * i) = 1.0;
      if (observed_ == Quantity::velocity) jacobian(0, 2 * i + 1) = 1.0;
      if (observed_ != Quantity::acceleration) continue;
      jacobian.block<1, 2>(0, 2 * i) << -stiffness(state, i), -damping(state, i);
      if (i < unknown_) jacobian.block<1, 2>(0, 2 * count_ + 2 * i) = -state.segment<2>(2 * i).transpose();
    }
  }

 private:
  std::vector<BankMember> members_;
  Quantity observed_;
  double interval_;
  Index count_, unknown_ = 0;
  MatrixXd process_, noise_;

  Index size() const { return 2 * count_ + 2 * unknown_; }
  double stiffness(const VectorXd& state, Index i) const {
    return i < unknown_ ? state[2 * count_ + 2 * i] : members_[i].stiffness;
  }
  double damping(const VectorXd& state, Index i) const {
    return i < unknown_ ? state[2 * count_ + 2 * i + 1] : members_[i].damping;
  }
};

}  // namespace

std::unique_ptr<filters::DiscreteModel> oscillator_bank(const std::vector<BankMember>& members,
                                                        Quantity observed, double interval, double variance) {
  return std::make_unique<Bank>(members, observed, interval, variance);
}

}  // namespace beamid::experiments
