// Calls into Python from threads that Python may not know.
#pragma once

#include <pybind11/pybind11.h>

#include <stdexcept>
#include <string>

namespace beamid::python {

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

}  // namespace beamid::python
