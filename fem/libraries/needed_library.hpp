// Libraries of the system that few runs need: each is loaded when one of its functions is first called. A
// start takes no longer for them, and what does not use them runs where they are missing.
//
//     constexpr NeededLibrary sndfile{"libsndfile.so.1", "libsndfile1"};
//     BEAMID_NEEDED(sndfile, sf_open);              // in a namespace: hides the function that <sndfile.h>
//     declares
//     ... sf_open(file, SFM_READ, &info) ...        // as if it were linked
#pragma once

#include <dlfcn.h>

#include <atomic>
#include <stdexcept>
#include <string>

namespace beamid {

/// A shared library of the system. It is loaded at its first use and stays until the program ends.
class NeededLibrary {
 public:
  /// @param name of the shared object: "libsndfile.so.1". @param package of Debian that holds it.
  /// @param visibility RTLD_GLOBAL for a library whose own modules take its functions from the program.
  constexpr NeededLibrary(const char* name, const char* package, int visibility = RTLD_LOCAL)
      : name_(name), package_(package), visibility_(visibility) {}

  /// Whether the system has the library.
  bool there() const { return handle() != nullptr; }

  /// Whether it has a function of that name, which older versions lack.
  bool has(const char* symbol_name) const { return there() && dlsym(handle(), symbol_name) != nullptr; }

  /// Address of a function or variable.
  /// @throws std::runtime_error without the library, or where the library lacks the symbol.
  void* symbol(const char* symbol_name) const {
    if (!there()) throw std::runtime_error(missing());
    if (void* const found = dlsym(handle(), symbol_name)) return found;
    throw std::runtime_error(std::string(name_) + " has no " + symbol_name +
                             "; expected the version that beamid was built with");
  }

  /// What to say where there is no such library.
  std::string missing() const {
    return std::string(name_) + " is missing; expected that library: it is in Debian's package " + package_;
  }

 private:
  void* handle() const { return dlopen(name_, RTLD_NOW | visibility_); }  // the same one every time

  const char* name_;
  const char* package_;
  int visibility_;
};

/// A symbol of such a library, looked up at its first use.
class NeededSymbol {
 public:
  constexpr NeededSymbol(const NeededLibrary& library, const char* name) : library_(library), name_(name) {}

 protected:
  /// @param in_program whether a definition in the program counts before that of the library
  void* address(bool in_program = false) const {
    void* known = found_.load(std::memory_order_relaxed);
    if (known == nullptr) {
      if (in_program && library_.there()) known = dlsym(RTLD_DEFAULT, name_);
      if (known == nullptr) known = library_.symbol(name_);
      found_.store(known, std::memory_order_relaxed);
    }
    return known;
  }

 private:
  const NeededLibrary& library_;
  const char* name_;
  mutable std::atomic<void*> found_{nullptr};
};

/// A function. Called, or handed on as a pointer, it throws what NeededLibrary::symbol throws.
template <class Function>
class NeededFunction : NeededSymbol {
 public:
  using NeededSymbol::NeededSymbol;
  operator Function*() const { return reinterpret_cast<Function*>(address()); }
};

/// A variable. A program that links the library, too, may hold the variable itself (a copy relocation), and
/// the library uses that one.
template <class Value>
class NeededVariable : NeededSymbol {
 public:
  using NeededSymbol::NeededSymbol;
  operator const Value&() const { return *static_cast<const Value*>(address(true)); }
  void* operator&() const { return address(true); }  // also of a type that its header does not define
};

}  // namespace beamid

// By a second macro each: the library's header may have a macro of that name, for a versioned one.
#define BEAMID_NEEDED_NAMED(library, function) \
  inline constinit const ::beamid::NeededFunction<decltype(::function)> function(library, #function)
#define BEAMID_NEEDED_VARIABLE_NAMED(library, variable) \
  inline constinit const ::beamid::NeededVariable<decltype(::variable)> variable(library, #variable)
#define BEAMID_NEEDED(library, function) BEAMID_NEEDED_NAMED(library, function)
#define BEAMID_NEEDED_VARIABLE(library, variable) BEAMID_NEEDED_VARIABLE_NAMED(library, variable)
