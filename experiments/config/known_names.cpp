#include "experiments/config/known_names.hpp"

#include "experiments/text/spelling.hpp"

namespace beamid::experiments {

std::string known_names(const std::string& word, const std::vector<std::string>& known) {
  constexpr std::size_t few = 6;
  const auto meant = nearest(word, known);
  std::string all = "known: " + joined(known);
  if (!meant) return all;
  return "did you mean '" + *meant + "'?" + (known.size() <= few ? " " + all : "");
}

}  // namespace beamid::experiments
