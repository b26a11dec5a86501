// The data of figures inside a page: what experiments/results/page/figures.js draws.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/results/figure.hpp"

namespace beamid::experiments {

/// Most bytes that the data of all figures of one page take.
inline constexpr std::size_t most_page_bytes = 1'000'000;

/// Attributes of each figure's element, in the order of the figures:
///
///     data-figure="..."  base64 of JSON: name, columns, row_height [px], panels with title, axes (label,
///     log,
///                        range as drawn in the static picture), curves (label, style, colour, mark, columns)
///     data-values="..."  base64 of the columns, little-endian
///
/// A column is {n, from, step} where its values are equally spaced, to 1e-9 of its span; otherwise {n, at,
/// size}, where `at` counts bytes: 8 bytes a value up to 1000 values, 4 beyond. What was left out of a grid
/// has "counts" too, 1 or 2 bytes: so many steps after the value before.
///
/// What a click on a point shows stands beside its curve: "facts" (label, column), "shapes" (columns of real
/// and imaginary parts, largest 1, the channels of a point together) and "details", numbers of the figure's
/// "details" (title, rows, note, command, mode).
///
/// Where the whole takes more than `most` bytes, columns of lines have codes of 2 bytes: the value is low +
/// step code, or with "log" its exponential; 65535 is no number. Where that is too much, lines are thinned to
/// one limit that fits (envelope() of figure.hpp). "thinned" states both in words.
std::vector<std::string> figure_attributes(const std::vector<Figure>& figures,
                                           std::size_t most = most_page_bytes);

/// The address of a static picture, "data:image/svg+xml,...", by which a page holds it. Blanks in a row are
/// one, what an address or an attribute would end at stands by its code [rfc3986], and the points of
/// gnuplot's paths to a tenth of a pixel from the one before: half the bytes of base64.
std::string picture_address(std::string_view svg);

/// The scripts of a page, as one element, and its hash as a policy of the page's contents names it.
/// @return "" in both where the page has nothing that moves.
struct PageScript {
  std::string element;  ///< "<script>...</script>"
  std::string policy;   ///< "'sha256-...'"
};
PageScript page_script();

/// How a page looks, as text of a <style> element.
std::string_view page_style();

}  // namespace beamid::experiments
