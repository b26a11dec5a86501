// A filter that is a class of Python.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "filters/filter.hpp"
#include "filters/innovation.hpp"

namespace beamid::python {

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

}  // namespace beamid::python
