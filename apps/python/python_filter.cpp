#include "apps/python/python_filter.hpp"

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <stdexcept>
#include <utility>

#include "apps/python/in_python.hpp"

namespace beamid::python {

namespace py = pybind11;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

/// @throws std::runtime_error where correct(y, u) returned what is no innovation with its covariance
void check_shapes(const VectorXd& innovation, const MatrixXd& covariance, Index outputs) {
  if (innovation.size() != outputs)
    throw std::runtime_error(
        fmt::format("correct returned an innovation of {} numbers; expected {}", innovation.size(), outputs));
  if (covariance.rows() != outputs || covariance.cols() != outputs)
    throw std::runtime_error(
        fmt::format("correct returned a covariance of the shape ({}, {}); expected ({}, {})",
                    covariance.rows(), covariance.cols(), outputs, outputs));
  constexpr double rounding = 1e-9;
  if (!((covariance - covariance.transpose()).cwiseAbs().maxCoeff() <= rounding * covariance.norm()))
    throw std::runtime_error("correct returned a covariance that is not symmetric");
}

}  // namespace

PythonFilter::PythonFilter(std::unique_ptr<filters::DiscreteModel> model, const py::object& make,
                           const filters::Options& options)
    : Filter(std::move(model)) {
  in_python([&] {
    py::dict words;
    for (const auto& [name, value] : options.values()) words[py::str(name)] = py::cast(value);
    auto* const seen = static_cast<filters::DiscreteModel*>(&model_);
    object_ = new py::object(make(py::cast(seen, py::return_value_policy::reference), **words));
  });
}

PythonFilter::~PythonFilter() {
  const py::gil_scoped_acquire lock;
  delete object_;
}

void PythonFilter::reset(const filters::Gaussian& estimate) {
  filters::check_estimate(estimate, model_);
  filters::Gaussian whole = estimate;
  if (whole.covariance.size() == 0) whole.covariance = estimate.factor * estimate.factor.transpose();
  in_python([&] { object_->attr("reset")(whole.mean, whole.covariance); });
  read();
}

void PythonFilter::predict(const VectorXd& input) {
  in_python([&] { object_->attr("predict")(input); });
  read();
}

void PythonFilter::take_in(const VectorXd& output, const VectorXd& input) {
  in_python([&] {
    const auto said = object_->attr("correct")(output, input).cast<std::pair<VectorXd, MatrixXd>>();
    check_shapes(said.first, said.second, output.size());
    correction_.innovation = said.first;
    correction_.innovation_covariance = said.second;
  });
  filters::weigh(correction_, MatrixXd(0, output.size()), factor_);
  read();
}

void PythonFilter::read() {
  in_python([&] {
    estimate_ = {object_->attr("mean").cast<VectorXd>(), object_->attr("covariance").cast<MatrixXd>(), {}};
  });
  filters::check_finite(estimate_);
}

filters::FilterRegistry::Entry entry_of(std::string name, std::string summary, std::string source,
                                        std::vector<filters::OptionSpec> options,
                                        std::set<std::string> contracts, const py::object& make) {
  const auto* const kept = new py::object(make);
  return {std::move(name),
          std::move(summary),
          std::move(source),
          std::move(options),
          std::move(contracts),
          [kept](std::unique_ptr<filters::DiscreteModel> model, const filters::Options& chosen) {
            return std::make_unique<PythonFilter>(std::move(model), *kept, chosen);
          }};
}

}  // namespace beamid::python
