// Results and tables for a terminal of any width.
#pragma once

#include <ostream>

#include "experiments/results/results.hpp"
#include "experiments/results/text.hpp"

namespace beamid::experiments {

/// Headings, paragraphs and tables in their order, at most as wide as the page.
void print(std::ostream& terminal, const Results& results, const Page& page);

/// A table as in table.hpp, on a page of any width.
void print(std::ostream& stream, const Table& table, const Page& paper);

}  // namespace beamid::experiments
