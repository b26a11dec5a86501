// A chain whose storeys need not be linear:
//
//     M q'' + C q' + K q + sum_s b_s (r_s - k_s d_s) = E f,    d_s = b_s^T q,    h_s' = g_s(d_s, d_s', h_s)
//
// q are the floors' displacements from the base, K the stiffness at rest, k_s that of storey s, r_s and g_s
// by its law (springs/spring_law.hpp). State [q, q', (b, d) of drifting sensors, eta, b of the others, h,
// eta of the laws]: up to h that of the linear chain, whose forces are those measured and then k_s d_s - r_s.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "experiments/models/motion/second_order_motion.hpp"
#include "experiments/models/springs/spring_law.hpp"

namespace beamid::experiments {

/// The linear chain in the displacements of its floors: modes at the guess, turned back.
class FloorMotion final : public SecondOrderMotion {
 public:
  /// @param shapes of the modes, a row for each floor (n x n)
  /// @param rows what the observations read of the floors (p x n)
  FloorMotion(std::shared_ptr<const ReducedMotion> modes, const Eigen::MatrixXd& shapes,
              Eigen::MatrixXd rows);

  void evaluate(const Eigen::VectorXd& state, SecondOrderForm& form,
                std::vector<SecondOrderForm>* slopes) const override;
  bool decoupled() const override { return false; }
  Eigen::VectorXd frequencies() const override { return modes_->frequencies(); }

 private:
  std::shared_ptr<const ReducedMotion> modes_;
  Eigen::MatrixXd shapes_, inverse_;

  std::shared_ptr<const SecondOrderMotion> copy() const override {
    return std::make_shared<FloorMotion>(*this);
  }
};

/// A storey whose spring follows a law.
struct LawStorey {
  int number = 1;  ///< from the lowest up
  std::shared_ptr<const SpringLaw> law;
  Eigen::VectorXd drift;               ///< b (n)
  double stiffness = 0.0;              ///< k at p_0 [N/m]
  Eigen::VectorXd stiffness_slopes;    ///< dk/dp_j of the chain's properties (a)
  SpringVector parameters;             ///< [k, p_2 .. p_k] where nothing drives them
  std::vector<Eigen::Index> unknowns;  ///< of the laws, that drives each parameter beside k; -1: none
};

class StoreyMotion final : public filters::ContinuousModel {
 public:
  /// @param floors whose last inputs are forces along b_s, one for each storey
  /// @param unknowns of the laws
  StoreyMotion(std::shared_ptr<const FloorMotion> floors, std::vector<LawStorey> storeys,
               std::vector<Unknown> unknowns);

  Eigen::Index input_size() const override;
  std::vector<filters::Label> state_labels() const override;
  std::vector<filters::Label> output_labels() const override { return floors_->output_labels(); }
  void rate(const Eigen::VectorXd& state, const Eigen::VectorXd& input, Eigen::VectorXd& rate) const override;
  void rate_jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                     Eigen::MatrixXd& jacobian) const override;
  void output(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
              Eigen::VectorXd& output) const override;
  void output_jacobian(const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                       Eigen::MatrixXd& jacobian) const override;
  /// `runge_kutta_4` in parts of the step that the fastest mode asks for (storey_motion.cpp).
  std::unique_ptr<filters::DiscreteModel> structured(double dt, const std::string& scheme,
                                                     const filters::Noise& noise) const override;

  /// Equations at a state's unknowns, which stay while the state moves.
  struct Equations {
    SecondOrderForm form;
    std::vector<SecondOrderForm> slopes;  ///< by eta of the linear chain; where asked for
    PhysicalValues at;
  };
  void evaluate(const Eigen::VectorXd& state, bool slopes, Equations& equations) const;
  void rate(const Equations& equations, const Eigen::VectorXd& state, const Eigen::VectorXd& input,
            Eigen::VectorXd& rate) const;
  /// @param slopes of the equations are there
  void rate_jacobian(const Equations& equations, const Eigen::VectorXd& state, const Eigen::VectorXd& input,
                     Eigen::MatrixXd& jacobian) const;

  const FloorMotion& floors() const { return *floors_; }
  Eigen::Index floor_count() const { return floors_->layout().coordinates; }  ///< n
  Eigen::Index size() const { return law_unknowns_at() + static_cast<Eigen::Index>(unknowns_.size()); }
  Eigen::Index slips_at() const { return floors_->layout().size; }  ///< place of the first h
  Eigen::Index slips() const { return slips_; }
  Eigen::Index law_unknowns_at() const { return slips_at() + slips_; }  ///< place of the laws' first eta

 private:
  struct Springs;
  std::shared_ptr<const FloorMotion> floors_;
  std::vector<LawStorey> storeys_;
  std::vector<Unknown> unknowns_;
  Eigen::Index slips_ = 0;

  Springs springs_at(const Equations& equations, const Eigen::VectorXd& state, bool slopes) const;
  Eigen::VectorXd forces(const Eigen::VectorXd& input, const Springs& springs) const;
};

}  // namespace beamid::experiments
