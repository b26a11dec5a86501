// What an axis shows and where its ticks are, in gnuplot's language.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "experiments/results/figure.hpp"
#include "experiments/results/table.hpp"

namespace beamid::experiments {

// Pieces of a web page.

// One cell of a table as text.

/// With two digits of its uncertainty, "3.4555" of 3.45549 +- 0.00023, at most twelve decimals, and with six
/// digits where that is not known; with an exponent where it is very large or small; NaN as "-".
std::string rounded_text(const Rounded& number);

/// A text as it is, a rounded number likewise, a number in its column's format, without a sign where that is
/// a zero, NaN as "-".
/// @throws std::invalid_argument when the format does not suit a number.
std::string cell_text(const Column& column, const Cell& cell);

/// Text, cleaned (fields.hpp), with the characters that HTML takes for its own written as entities.
std::string escaped(std::string_view text);

/// The text that escaped() was made of.
std::string unescaped(std::string_view html);

/// [rfc4648]
std::string base64(std::string_view bytes);

/// As escaped(), with the signs of gnuplot_axes.hpp.
std::string typeset_html(std::string_view text);

/// The table with its title and note. A column of numbers, written or not, stands to the right with its
/// decimal points below each other.
std::string html_table(const Table& table);

/// An SVG file as a picture inside the page with its caption, so that the page needs no other file.
/// @param caption typeset as text
/// @param attributes further ones of the figure's element, as they stand: " name=\"value\""
/// @throws std::runtime_error when the file cannot be read.
std::string html_picture(const std::filesystem::path& svg, std::string_view description,
                         std::string_view caption, std::string_view attributes = {});

// Signs that a terminal is spared and a page or picture has.

/// "+-" as "±", "chi^2" as "χ²", "10^-8" as "10⁻⁸", and the exponents of units ("m/s2", "N m2", "[m2]")
/// raised. A name such as "m2" stays: an exponent is raised only behind a number, "[", "/" or another unit.
std::string typeset(std::string_view text);

/// The smallest and the largest of some values.
struct Extent {
  double low, high;

  Extent();

  /// Takes the finite values in; of those only the positive ones, if so wished.
  void add(const Eigen::VectorXd& values, bool positive);
  bool empty() const { return !(low <= high); }
};

/// Label, range and ticks of an axis.
struct DrawnAxis {
  std::string commands;
  double widest = 0;                         ///< [px] of its ticks' labels, in the SVG
  std::pair<double, double> range = {0, 1};  ///< from left to right, from below upwards
};

/// @param length [px] of the frame along the axis, in the SVG: as many ticks as have room there.
DrawnAxis drawn_x_axis(const Panel& panel, double length);

/// With room for a legend inside the frame. @param length as above
DrawnAxis drawn_y_axis(const Panel& panel, double length);

}  // namespace beamid::experiments
