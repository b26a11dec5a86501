// A model of a filter that is an object of Python, and models as Python sees them.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "filters/discrete_model.hpp"

namespace beamid::python {

/// transition(z, u) and output(z, u) of a Python object, with transition_jacobian and output_jacobian where
/// it has them; output_noise (p x p) and, where there is any, process_noise (n x n).
class PythonModel final : public filters::DiscreteModel {
 public:
  /// @throws std::invalid_argument where a noise has another shape
  PythonModel(pybind11::object object, Eigen::Index states, Eigen::Index outputs);
  PythonModel(const PythonModel&) = delete;
  PythonModel& operator=(const PythonModel&) = delete;
  ~PythonModel() override;

  std::vector<filters::Label> state_labels() const override;
  std::vector<filters::Label> output_labels() const override;
  const Eigen::MatrixXd& process_noise() const override { return process_; }
  const Eigen::MatrixXd& output_noise() const override { return output_; }
  double interval() const override { return interval_; }
  void transition(const Eigen::VectorXd& z, const Eigen::VectorXd& u, Eigen::VectorXd& next) override;
  void linearised_transition(const Eigen::VectorXd& z, const Eigen::VectorXd& u, Eigen::VectorXd& next,
                             Eigen::MatrixXd& jacobian) override;
  void output(const Eigen::VectorXd& z, const Eigen::VectorXd& u, Eigen::VectorXd& y) override;
  void output_jacobian(const Eigen::VectorXd& z, const Eigen::VectorXd& u,
                       Eigen::MatrixXd& jacobian) override;

 private:
  pybind11::object* object_;
  Eigen::Index states_, outputs_;
  Eigen::MatrixXd process_, output_;
  double interval_ = 1.0;
  bool has_transition_jacobian_ = false, has_output_jacobian_ = false;
};

/// The class `Model`, which a filter of Python's own is given.
void add_model(pybind11::module_& module);

}  // namespace beamid::python
