// Filters on arrays: any registered filter on a model that is a Python object, and filters that are Python
// classes.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>

namespace beamid::python {

/// `run_filter`, `run_oscillator`, `register_filter`, `filter_options` and the class `Model` that a filter of
/// Python's own is given.
void add_filters(pybind11::module_& module);

}  // namespace beamid::python
