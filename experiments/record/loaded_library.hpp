// Libraries that few files need, loaded when one of these is read: a start takes no longer for them.
#pragma once

#include <string>

namespace beamid::experiments {

/// A shared object of the system.
class LoadedLibrary {
 public:
  /// @param name of the shared object: "libsndfile.so.1". @param package of Debian that holds it.
  /// @throws InputError at `file` where there is no such library.
  LoadedLibrary(const std::string& file, const char* name, const char* package);

  /// Whether it has a function of that name, which older versions lack.
  bool has(const char* name) const;

  /// A function of it, of the type that the library's header gives it:
  /// function<decltype(sf_open)>("sf_open").
  /// @throws std::runtime_error when there is none.
  template <class Function>
  Function* function(const char* name) const {
    return reinterpret_cast<Function*>(symbol(name));
  }

 private:
  void* symbol(const char* name) const;

  void* handle_;  // stays until the program ends
};

}  // namespace beamid::experiments
