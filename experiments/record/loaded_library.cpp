#include "experiments/record/loaded_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>

#include "experiments/text/input_error.hpp"

namespace beamid::experiments {

LoadedLibrary::LoadedLibrary(const std::string& file, const char* name, const char* package)
    : handle_(dlopen(name, RTLD_NOW | RTLD_LOCAL)) {
  if (handle_ == nullptr)
    throw InputError({file, 0, 0}, fmt::format("cannot be read without {}; expected that library: it is in "
                                               "Debian's package {}",
                                               name, package));
}

bool LoadedLibrary::has(const char* name) const {
  return dlsym(handle_, name) != nullptr;
}

void* LoadedLibrary::symbol(const char* name) const {
  void* const found = dlsym(handle_, name);
  if (found == nullptr) throw std::runtime_error(std::string("a library without ") + name);
  return found;
}

}  // namespace beamid::experiments
