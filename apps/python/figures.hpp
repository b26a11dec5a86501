// The curves of results as numpy arrays.
#pragma once

#include <pybind11/pybind11.h>

#include "apps/python/run.hpp"

namespace beamid::python {

/// {name: {caption, panels: [{title, x_label, y_label, curves: [{label, style, x, y, lower, upper}]}]}}; the
/// arrays (N) lie in the outcome's own memory, which they keep alive.
/// @param owner the Python object of the outcome
pybind11::dict figures(const Outcome& outcome, const pybind11::object& owner);

/// {(run, name): values (N, p)}, likewise; run "" where there is only one.
pybind11::dict arrays(const Outcome& outcome, const pybind11::object& owner);

}  // namespace beamid::python
