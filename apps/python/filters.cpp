#include "apps/python/filters.hpp"

#include <pybind11/eigen.h>

#include <memory>
#include <stdexcept>

#include "filters/batch.hpp"
#include "filters/filter.hpp"
#include "filters/filter_run.hpp"
#include "filters/innovation.hpp"

namespace beamid::python {
namespace {

namespace py = pybind11;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::DiscreteModel;

// What Python throws becomes an error of C++, which may leave threads that Python does not know.
template <class Call>
auto in_python(const Call& call) {
  const py::gil_scoped_acquire lock;
  try {
    return call();
  } catch (const py::error_already_set& error) {
    throw std::runtime_error(error.what());
  } catch (const py::cast_error& error) {
    throw std::runtime_error(std::string("a function in Python returned no array of numbers: ") +
                             error.what());
  }
}

MatrixXd matrix_of(const py::object& owner, const char* name, Index rows, Index columns) {
  const MatrixXd matrix = owner.attr(name).cast<MatrixXd>();
  if (matrix.rows() != rows || matrix.cols() != columns)
    throw std::invalid_argument(std::string(name) + " has the shape (" + std::to_string(matrix.rows()) +
                                ", " + std::to_string(matrix.cols()) + "); expected (" +
                                std::to_string(rows) + ", " + std::to_string(columns) + ")");
  return matrix;
}

// transition(z, u) and output(z, u) of a Python object, with transition_jacobian and output_jacobian where it
// has them.
class PythonModel final : public DiscreteModel {
 public:
  PythonModel(py::object object, Index states, Index outputs)
      : object_(new py::object(std::move(object))), states_(states), outputs_(outputs) {
    if (py::hasattr(*object_, "process_noise") && !object_->attr("process_noise").is_none())
      process_ = matrix_of(*object_, "process_noise", states, states);
    output_ = matrix_of(*object_, "output_noise", outputs, outputs);
    interval_ = py::hasattr(*object_, "interval") ? object_->attr("interval").cast<double>() : 1.0;
    has_transition_jacobian_ = py::hasattr(*object_, "transition_jacobian");
    has_output_jacobian_ = py::hasattr(*object_, "output_jacobian");
  }
  PythonModel(const PythonModel&) = delete;
  PythonModel& operator=(const PythonModel&) = delete;
  ~PythonModel() override {
    const py::gil_scoped_acquire lock;
    delete object_;
  }

  std::vector<filters::Label> state_labels() const override { return labels("state_", states_); }
  std::vector<filters::Label> output_labels() const override { return labels("output_", outputs_); }
  const MatrixXd& process_noise() const override { return process_; }
  const MatrixXd& output_noise() const override { return output_; }
  double interval() const override { return interval_; }
  void transition(const VectorXd& z, const VectorXd& u, VectorXd& next) override {
    next = vector("transition", z, u, states_);
  }
  void linearised_transition(const VectorXd& z, const VectorXd& u, VectorXd& next,
                             MatrixXd& jacobian) override {
    if (!has_transition_jacobian_) return DiscreteModel::linearised_transition(z, u, next, jacobian);
    next = vector("transition", z, u, states_);
    jacobian = matrix("transition_jacobian", z, u, states_);
  }
  void output(const VectorXd& z, const VectorXd& u, VectorXd& y) override {
    y = vector("output", z, u, outputs_);
  }
  void output_jacobian(const VectorXd& z, const VectorXd& u, MatrixXd& jacobian) override {
    if (!has_output_jacobian_) return DiscreteModel::output_jacobian(z, u, jacobian);
    jacobian = matrix("output_jacobian", z, u, outputs_);
  }

 private:
  static std::vector<filters::Label> labels(const std::string& name, Index count) {
    std::vector<filters::Label> labels;
    for (Index i = 1; i <= count; ++i) labels.push_back({name + std::to_string(i), "1"});
    return labels;
  }
  VectorXd vector(const char* name, const VectorXd& z, const VectorXd& u, Index size) const {
    return in_python([&] {
      const VectorXd found = object_->attr(name)(z, u).cast<VectorXd>();
      if (found.size() != size)
        throw std::runtime_error(std::string(name) + " returned " + std::to_string(found.size()) +
                                 " numbers; expected " + std::to_string(size));
      return found;
    });
  }
  MatrixXd matrix(const char* name, const VectorXd& z, const VectorXd& u, Index rows) const {
    return in_python([&] {
      const MatrixXd found = object_->attr(name)(z, u).cast<MatrixXd>();
      if (found.rows() != rows || found.cols() != states_)
        throw std::runtime_error(std::string(name) + " returned a matrix of another shape");
      return found;
    });
  }

  py::object* object_;
  Index states_, outputs_;
  MatrixXd process_, output_;
  double interval_ = 1.0;
  bool has_transition_jacobian_ = false, has_output_jacobian_ = false;
};

// A filter that is a Python object: reset(mean, covariance), predict(u), correct(y, u) -> (innovation, S),
// mean, covariance.
class PythonFilter final : public filters::Filter {
 public:
  PythonFilter(std::unique_ptr<DiscreteModel> model, const py::object& make, const filters::Options& options)
      : Filter(std::move(model)) {
    in_python([&] {
      py::dict words;
      for (const auto& [name, value] : options.values()) words[py::str(name)] = py::cast(value);
      object_ = new py::object(
          make(py::cast(static_cast<DiscreteModel*>(&model_), py::return_value_policy::reference), **words));
    });
  }
  PythonFilter(const PythonFilter&) = delete;
  PythonFilter& operator=(const PythonFilter&) = delete;
  ~PythonFilter() override {
    const py::gil_scoped_acquire lock;
    delete object_;
  }

  void reset(const filters::Gaussian& belief) override {
    filters::Gaussian whole = belief;
    if (whole.covariance.size() == 0) whole.covariance = belief.factor * belief.factor.transpose();
    in_python([&] { object_->attr("reset")(whole.mean, whole.covariance); });
    read();
  }
  void predict(const VectorXd& input) override {
    in_python([&] { object_->attr("predict")(input); });
    read();
  }
  const filters::Gaussian& belief() const override { return belief_; }

 protected:
  void take_in(const VectorXd& output, const VectorXd& input) override {
    in_python([&] {
      const auto said = object_->attr("correct")(output, input).cast<std::pair<VectorXd, MatrixXd>>();
      if (said.first.size() != output.size() || said.second.rows() != output.size())
        throw std::runtime_error("correct returned an innovation of another size than the outputs'");
      correction_.innovation = said.first;
      correction_.innovation_covariance = said.second;
    });
    filters::weigh(correction_, MatrixXd(0, output.size()), factor_);
    read();
  }

 private:
  void read() {
    in_python([&] {
      belief_ = {object_->attr("mean").cast<VectorXd>(), object_->attr("covariance").cast<MatrixXd>(), {}};
    });
    filters::check_finite(belief_);
  }

  py::object* object_ = nullptr;
  filters::Gaussian belief_;
  Eigen::LLT<MatrixXd> factor_;
};

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
                       all ? filters::Keep::all_beliefs : filters::Keep::last_belief);
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

// Kept to the end of the process: the registry outlives the interpreter.
void register_filter(const std::string& name, const std::string& summary, const std::string& source,
                     const std::vector<std::tuple<std::string, filters::OptionValue, std::string>>& options,
                     const py::object& make) {
  filters::FilterRegistry::Entry entry{name, summary, source, {}, {}, {}};
  for (const auto& [option, fallback, meaning] : options)
    entry.options.push_back({option, fallback, "", meaning});
  const auto* const kept = new py::object(make);
  entry.make = [kept](std::unique_ptr<DiscreteModel> model, const filters::Options& chosen) {
    return std::make_unique<PythonFilter>(std::move(model), *kept, chosen);
  };
  try {
    filters::filter_registry().add(std::move(entry));
  } catch (const std::logic_error& error) {
    throw std::invalid_argument(error.what());
  }
}

}  // namespace

void add_filters(py::module_& module) {
  py::class_<DiscreteModel>(module, "Model")
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
