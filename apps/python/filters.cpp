#include "apps/python/filters.hpp"

#include <pybind11/eigen.h>

#include <memory>
#include <stdexcept>

#include "apps/python/python_filter.hpp"
#include "apps/python/python_model.hpp"
#include "filters/batch.hpp"
#include "filters/filter.hpp"
#include "filters/filter_run.hpp"

namespace beamid::python {
namespace {

namespace py = pybind11;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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
