#include "apps/python/python_model.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "apps/python/in_python.hpp"

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

}  // namespace beamid::python
