// A figure's pictures, drawn by gnuplot; its data and script, which need none.
#pragma once

#include <filesystem>
#include <stdexcept>

#include "experiments/results/figure.hpp"

namespace beamid::experiments {

/// A figure without pictures is no reason to lose what was computed.
class NotDrawn : public std::runtime_error {
 public:
  /// @param hopeless no other figure will be drawn either: gnuplot is missing, or does not end.
  NotDrawn(const std::string& message, bool hopeless) : std::runtime_error(message), hopeless_(hopeless) {}
  bool hopeless() const { return hopeless_; }

 private:
  bool hopeless_;
};

/// Writes NAME.csv and NAME.gp. @throws std::invalid_argument, std::runtime_error as write() of
/// compared_laws.cpp.
void write_data(const Figure& figure, const std::filesystem::path& folder);

/// Draws NAME.svg and NAME.png from them; gnuplot has two minutes for it.
/// @throws NotDrawn when gnuplot is missing, fails or does not end; neither picture is left then.
/// @throws std::runtime_error when it has written nothing.
void draw(const Figure& figure, const std::filesystem::path& folder);

}  // namespace beamid::experiments
