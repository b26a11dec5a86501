// The compiled core of the Python package: apps/python/beamid makes of it what users see.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "apps/python/filters.hpp"
#include "apps/python/module.hpp"
#include "experiments/config/key_tables.hpp"

namespace py = pybind11;
using beamid::python::Outcome;

PYBIND11_MODULE(_beamid, module) {
  module.doc() = "Compiled core of the package beamid.";
  py::class_<Outcome, std::shared_ptr<Outcome>>(module, "Outcome")
      .def_readonly("code", &Outcome::code)
      .def_property_readonly("has_results",
                             [](const Outcome& outcome) { return outcome.results.has_value(); })
      .def_property_readonly("message",
                             [](const Outcome& one) { return one.refusal ? one.refusal->message : ""; })
      .def("json", &Outcome::json, py::call_guard<py::gil_scoped_release>())
      .def("report", &Outcome::report, py::call_guard<py::gil_scoped_release>())
      .def("arrays", [](const py::object& self) { return arrays(self.cast<const Outcome&>(), self); })
      .def("figures", [](const py::object& self) { return figures(self.cast<const Outcome&>(), self); })
      .def("write", &Outcome::write, py::call_guard<py::gil_scoped_release>());
  module.def("run", [](const std::string& command, const std::vector<std::string>& words) {
    return std::make_shared<Outcome>(beamid::python::run(command, words));
  });
  module.def("main", &beamid::python::run_main, py::call_guard<py::gil_scoped_release>());
  module.def("specification", &beamid::python::specification);
  module.def("known_names", &beamid::experiments::known_names);
  module.def("write_columns", &beamid::python::write_columns);
  module.def("read_record", &beamid::python::read_record);
  beamid::python::add_filters(module);
}
