#include "apps/python/filters.hpp"

#include <memory>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "filters/batch.hpp"
#include "filters/filter.hpp"
#include "filters/filter_run.hpp"

namespace beamid::python {
namespace {

namespace py = pybind11;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::DiscreteModel;

void expect_shape(const char* name, const MatrixXd& matrix, Index rows, Index columns) {
  if (matrix.rows() != rows || matrix.cols() != columns)
    throw std::invalid_argument(fmt::format("{} has the shape ({}, {}); expected ({}, {})", name,
                                            matrix.rows(), matrix.cols(), rows, columns));
}

std::vector<filters::Label> numbered(const std::string& name, Index count) {
  std::vector<filters::Label> labels;
  for (Index i = 1; i <= count; ++i) labels.push_back({name + std::to_string(i), "1"});
  return labels;
}

VectorXd vector(const py::object& owner, const char* name, const VectorXd& z, const VectorXd& u, Index size) {
  return in_python([&] {
    const VectorXd found = owner.attr(name)(z, u).cast<VectorXd>();
    if (found.size() != size)
      throw std::runtime_error(fmt::format("{} returned {} numbers; expected {}", name, found.size(), size));
    return found;
  });
}

MatrixXd matrix(const py::object& owner, const char* name, const VectorXd& z, const VectorXd& u, Index rows) {
  return in_python([&] {
    MatrixXd found = owner.attr(name)(z, u).cast<MatrixXd>();
    expect_shape(name, found, rows, z.size());
    return found;
  });
}

}  // namespace

PythonModel::PythonModel(py::object object, Index states, Index outputs)
    : object_(new py::object(std::move(object))), states_(states), outputs_(outputs) {
  if (py::hasattr(*object_, "process_noise") && !object_->attr("process_noise").is_none()) {
    process_ = object_->attr("process_noise").cast<MatrixXd>();
    expect_shape("process_noise", process_, states, states);
  }
  output_ = object_->attr("output_noise").cast<MatrixXd>();
  expect_shape("output_noise", output_, outputs, outputs);
  interval_ = py::hasattr(*object_, "interval") ? object_->attr("interval").cast<double>() : 1.0;
  has_transition_jacobian_ = py::hasattr(*object_, "transition_jacobian");
  has_output_jacobian_ = py::hasattr(*object_, "output_jacobian");
}

PythonModel::~PythonModel() {
  const py::gil_scoped_acquire lock;
  delete object_;
}

std::vector<filters::Label> PythonModel::state_labels() const {
  return numbered("state_", states_);
}

std::vector<filters::Label> PythonModel::output_labels() const {
  return numbered("output_", outputs_);
}

void PythonModel::transition(const VectorXd& z, const VectorXd& u, VectorXd& next) {
  next = vector(*object_, "transition", z, u, states_);
}

void PythonModel::linearised_transition(const VectorXd& z, const VectorXd& u, VectorXd& next,
                                        MatrixXd& jacobian) {
  if (!has_transition_jacobian_) return DiscreteModel::linearised_transition(z, u, next, jacobian);
  next = vector(*object_, "transition", z, u, states_);
  jacobian = matrix(*object_, "transition_jacobian", z, u, states_);
}

void PythonModel::output(const VectorXd& z, const VectorXd& u, VectorXd& y) {
  y = vector(*object_, "output", z, u, outputs_);
}

void PythonModel::output_jacobian(const VectorXd& z, const VectorXd& u, MatrixXd& jacobian) {
  if (!has_output_jacobian_) return DiscreteModel::output_jacobian(z, u, jacobian);
  jacobian = matrix(*object_, "output_jacobian", z, u, outputs_);
}

void add_model(py::module_& module) {
  py::class_<DiscreteModel>(module, "Model", py::module_local())
      .def_property_readonly("process_noise", [](const DiscreteModel& one) { return one.process_noise(); })
      .def_property_readonly("output_noise", [](const DiscreteModel& one) { return one.output_noise(); })
      .def_property_readonly("interval", &DiscreteModel::interval)
      .def_property_readonly("state_names",
                             [](const DiscreteModel& one) {
                               std::vector<std::string> names;
                               for (const filters::Label& label : one.state_labels())
                                 names.push_back(label.name);
                               return names;
                             })
      .def("transition",
           [](DiscreteModel& one, const VectorXd& z, const VectorXd& u) {
             VectorXd next;
             one.transition(z, u, next);
             return next;
           })
      .def("transition_jacobian",
           [](DiscreteModel& one, const VectorXd& z, const VectorXd& u) {
             VectorXd next;
             MatrixXd jacobian;
             one.linearised_transition(z, u, next, jacobian);
             return jacobian;
           })
      .def("output",
           [](DiscreteModel& one, const VectorXd& z, const VectorXd& u) {
             VectorXd y;
             one.output(z, u, y);
             return y;
           })
      .def("output_jacobian", [](DiscreteModel& one, const VectorXd& z, const VectorXd& u) {
        MatrixXd jacobian;
        one.output_jacobian(z, u, jacobian);
        return jacobian;
      });
}

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

namespace {

py::dict result_of(const filters::FilterRun& run, bool all) {
  py::dict found;
  found["mean"] = run.last.mean;
  found["covariance"] = run.last.covariance.size() > 0
                            ? run.last.covariance
                            : MatrixXd(run.last.factor * run.last.factor.transpose());
  found["log_likelihood"] = run.log_likelihood;
  found["innovations"] = MatrixXd(run.innovations.transpose());
  found["whitened_innovations"] = MatrixXd(run.whitened_innovations.transpose());
  found["failure"] = run.failure ? py::cast(run.failure->reason) : py::none();
  found["remarks"] = run.remarks;
  if (!all) return found;
  const auto samples = static_cast<Index>(run.filtered.size()), n = run.last.mean.size();
  MatrixXd means(samples, n), deviations(samples, n);
  for (Index k = 0; k < samples; ++k) {
    means.row(k) = run.filtered[static_cast<std::size_t>(k)].mean;
    deviations.row(k) = run.filtered[static_cast<std::size_t>(k)].deviations();
  }
  found["means"] = means;
  found["deviations"] = deviations;
  return found;
}

py::dict run_filter(const std::string& name, const filters::Options& options, const py::object& model,
                    const VectorXd& mean, const MatrixXd& covariance, const MatrixXd& outputs,
                    const MatrixXd& inputs, const VectorXd& time, bool all) {
  const auto filter = filters::filter_registry().make(
      name, options, std::make_unique<PythonModel>(model, mean.size(), outputs.cols()));
  const filters::Measurements record{time, outputs.transpose(), inputs.transpose()};
  filters::FilterRun run;
  {
    const py::gil_scoped_release release;
    run = filters::run(*filter, {mean, covariance, {}}, record,
                       all ? filters::Keep::all_estimates : filters::Keep::last_estimate);
  }
  return result_of(run, all);
}

filters::Quantity oscillator_quantity(const std::string& name) {
  if (name == "displacement") return filters::Quantity::displacement;
  if (name == "velocity") return filters::Quantity::velocity;
  if (name == "acceleration") return filters::Quantity::acceleration;
  throw std::invalid_argument("observed is '" + name + "'; expected displacement, velocity or acceleration");
}

// The extended filter on [x, v, K, C] by the vector engine; (mean, covariance, log likelihood).
py::tuple run_oscillator(double mass, double interval, const std::vector<std::string>& observed,
                         const VectorXd& noise, bool forward_euler, const VectorXd& mean,
                         const MatrixXd& covariance, const MatrixXd& outputs) {
  filters::OscillatorTrials kind;
  kind.mass = mass, kind.interval = interval, kind.forward_euler = forward_euler;
  for (const std::string& name : observed) kind.observed.push_back(oscillator_quantity(name));
  kind.output_noise = noise.cwiseAbs2().asDiagonal();
  filters::TrialResult found;
  {
    const py::gil_scoped_release release;
    found = filters::run_batch(kind, {{outputs.transpose(), {mean, covariance, {}}}}).front();
  }
  return py::make_tuple(found.last.mean, found.last.covariance, found.log_likelihood,
                        found.failed ? py::cast(*found.failed) : py::none());
}

void register_filter(const std::string& name, const std::string& summary, const std::string& source,
                     const std::vector<std::tuple<std::string, filters::OptionValue, std::string>>& options,
                     const py::object& make) {
  std::vector<filters::OptionSpec> specs;
  for (const auto& [option, fallback, meaning] : options) specs.push_back({option, fallback, "", meaning});
  try {
    filters::filter_registry().add(entry_of(name, summary, source, std::move(specs), {}, make));
  } catch (const std::logic_error& error) {
    throw std::invalid_argument(error.what());
  }
}

}  // namespace

void add_filters(py::module_& module) {
  add_model(module);
  module.def("run_filter",
             [](const std::string& name, const std::map<std::string, filters::OptionValue>& options,
                const py::object& model, const VectorXd& mean, const MatrixXd& covariance,
                const MatrixXd& outputs, const MatrixXd& inputs, const VectorXd& time, bool all) {
               filters::Options chosen;
               for (const auto& [option, value] : options) chosen.set(option, value);
               return run_filter(name, chosen, model, mean, covariance, outputs, inputs, time, all);
             });
  module.def("run_oscillator", &run_oscillator);
  module.def("register_filter", &register_filter);
}

}  // namespace beamid::python
