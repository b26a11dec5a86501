// What is wrong with a file, and where.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace beamid::experiments {

/// A place in a text file; line and column count from 1 and are 0 where unknown.
struct Place {
  std::string file;
  std::size_t line = 0;
  std::size_t column = 0;
};

/// "cantilever.toml:14:9", as compilers print it, so that editors can jump there.
inline std::string to_string(const Place& place) {
  std::string text = place.file;
  if (place.line > 0) text.append(":").append(std::to_string(place.line));
  if (place.line > 0 && place.column > 0) text.append(":").append(std::to_string(place.column));
  return text;
}

/// Bad input of the user's: what() reads "cantilever.toml:14:9: unknown filter 'ufk'; known: ekf, enkf, ukf".
class InputError : public std::runtime_error {
 public:
  /// @param message what was found and what was expected, without the place.
  InputError(Place place, const std::string& message)
      : std::runtime_error(to_string(place) + ": " + message), place_(std::move(place)) {}

  const std::string& file() const { return place_.file; }
  std::size_t line() const { return place_.line; }      ///< from 1; 0 when unknown
  std::size_t column() const { return place_.column; }  ///< from 1; 0 when unknown

 private:
  Place place_;
};

}  // namespace beamid::experiments
