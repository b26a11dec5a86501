// Filters on arrays: any registered filter on a model that is a Python object, and filters that are Python
// classes.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "filters/discrete_model.hpp"
#include "filters/filter.hpp"
#include "filters/innovation.hpp"

namespace beamid::python {

// Calls into Python from threads that Python may not know.

/// What `call` returns, made with Python's lock held. @throws std::runtime_error what Python throws
template <class Call>
auto in_python(const Call& call) {
  const pybind11::gil_scoped_acquire lock;
  try {
    return call();
  } catch (const pybind11::error_already_set& error) {
    throw std::runtime_error(error.what());
  } catch (const pybind11::cast_error& error) {
    throw std::runtime_error(std::string("a function in Python returned no array of numbers: ") +
                             error.what());
  }
}

// A model of a filter that is an object of Python, and models as Python sees them.

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

// A filter that is a class of Python.

/// An object of Python with reset(mean, covariance), predict(u), correct(y, u) -> (innovation, S), mean and
/// covariance.
class PythonFilter final : public filters::Filter {
 public:
  /// @param make of the model and the options, as keywords @throws std::runtime_error what it throws
  PythonFilter(std::unique_ptr<filters::DiscreteModel> model, const pybind11::object& make,
               const filters::Options& options);
  PythonFilter(const PythonFilter&) = delete;
  PythonFilter& operator=(const PythonFilter&) = delete;
  ~PythonFilter() override;

  void reset(const filters::Gaussian& estimate) override;
  void predict(const Eigen::VectorXd& input) override;
  const filters::Gaussian& estimate() const override { return estimate_; }

 protected:
  void take_in(const Eigen::VectorXd& output, const Eigen::VectorXd& input) override;

 private:
  void read();

  pybind11::object* object_ = nullptr;
  filters::Gaussian estimate_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

/// An entry of the registry whose filters are made by a function of Python.
/// @param make kept to the end of the process: the registry outlives the interpreter
filters::FilterRegistry::Entry entry_of(std::string name, std::string summary, std::string source,
                                        std::vector<filters::OptionSpec> options,
                                        std::set<std::string> contracts, const pybind11::object& make);

/// `run_filter`, `run_oscillator`, `register_filter`, `filter_options` and the class `Model` that a filter of
/// Python's own is given.
void add_filters(pybind11::module_& module);

}  // namespace beamid::python
