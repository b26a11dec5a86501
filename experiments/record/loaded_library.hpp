// Libraries that few files need, loaded when one of these is read: a start takes no longer for them.
#pragma once

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "experiments/text/input_error.hpp"

namespace beamid::experiments {

/// A shared object of the system.
class LoadedLibrary {
 public:
  /// @param name of the shared object: "libsndfile.so.1". @param package of Debian that holds it.
  /// @throws InputError at `file` where there is no such library.
  LoadedLibrary(const std::string& file, const char* name, const char* package)
      : handle_(dlopen(name, RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr)
      throw InputError({file, 0, 0}, fmt::format("cannot be read without {}; expected that library: it is in "
                                                 "Debian's package {}",
                                                 name, package));
  }

  /// Whether it has a function of that name, which older versions lack.
  bool has(const char* name) const { return dlsym(handle_, name) != nullptr; }

  /// A function of it, of the type that the library's header gives it:
  /// function<decltype(sf_open)>("sf_open").
  /// @throws std::runtime_error when there is none.
  template <class Function>
  Function* function(const char* name) const {
    return reinterpret_cast<Function*>(symbol(name));
  }

 private:
  void* symbol(const char* name) const {
    void* const found = dlsym(handle_, name);
    if (found == nullptr) throw std::runtime_error(std::string("a library without ") + name);
    return found;
  }

  void* handle_;  // stays until the program ends
};

}  // namespace beamid::experiments
