#include "experiments/text/spelling.hpp"

#include <algorithm>

namespace beamid::experiments {
namespace {

/// Optimal-string-alignment distance.
std::size_t distance(const std::string& from, const std::string& to) {
  const std::size_t columns = to.size() + 1;
  std::vector<std::size_t> cost((from.size() + 1) * columns);
  const auto at = [&](std::size_t i, std::size_t j) -> std::size_t& { return cost[i * columns + j]; };
  for (std::size_t i = 0; i <= from.size(); ++i) at(i, 0) = i;
  for (std::size_t j = 0; j <= to.size(); ++j) at(0, j) = j;
  for (std::size_t i = 1; i <= from.size(); ++i)
    for (std::size_t j = 1; j <= to.size(); ++j) {
      const std::size_t replaced = at(i - 1, j - 1) + (from[i - 1] == to[j - 1] ? 0 : 1);
      at(i, j) = std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, replaced});
      if (i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1])
        at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
    }
  return cost.back();
}

}  // namespace

std::optional<std::string> nearest(const std::string& word, const std::vector<std::string>& candidates) {
  constexpr std::size_t longest = 100;  // beyond it nothing is a slip of the finger, and the table would grow
  if (word.size() > longest) return std::nullopt;
  std::optional<std::string> best;
  std::size_t allowed = std::max<std::size_t>(2, word.size() / 3);
  for (const std::string& candidate : candidates) {
    if (std::max(word.size(), candidate.size()) - std::min(word.size(), candidate.size()) > allowed) continue;
    if (const std::size_t steps = distance(word, candidate); steps <= allowed && steps < candidate.size()) {
      if (best && steps == allowed) continue;
      best = candidate;
      allowed = steps;
    }
  }
  return best;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

}  // namespace beamid::experiments
