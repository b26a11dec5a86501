#include "experiments/identify/model_check/candidates.hpp"

#include <algorithm>
#include <stdexcept>

namespace beamid::experiments {
namespace {

Candidate record_clock() {
  Candidate c = relative_candidate("record_clock", 0.03, [](const fem::Structure& s, double) { return s; });
  c.of_clock = true;
  return c;
}

std::vector<Candidate> candidates_of_one(const fem::Structure& structure) {
  std::vector<Candidate> all = structure.matrices()   ? system_candidates(*structure.matrices())
                               : !structure.is_beam() ? frame_candidates(structure)
                               : structure.is_chain() ? chain_candidates(structure.beam())
                                                      : beam_candidates(structure.beam());
  all.push_back(record_clock());
  return all;
}

}  // namespace

Candidate relative_candidate(std::string name, double plausible,
                             std::function<fem::Structure(const fem::Structure&, double)> changed) {
  Candidate c{std::move(name), {}, "%", of_described, -0.9, 9, -plausible, plausible};
  c.label = c.name;
  std::replace(c.label.begin(), c.label.end(), '_', ' ');
  c.changed = [=](const fem::Structure& s, double x) { return changed(s, 1 + x); };
  c.value = [](const fem::Structure&, double x) { return 1 + x; };
  return c;
}

std::vector<Candidate> candidates_of(const std::vector<fem::Structure>& structures) {
  if (structures.empty()) throw std::invalid_argument("no structure; expected one at least");
  std::vector<Candidate> shared = candidates_of_one(structures.front());
  for (std::size_t s = 1; s < structures.size(); ++s) {
    const std::vector<Candidate> others = candidates_of_one(structures[s]);
    std::erase_if(shared, [&](Candidate& mine) {
      const auto other = std::find_if(others.begin(), others.end(),
                                      [&](const Candidate& one) { return one.name == mine.name; });
      if (other == others.end()) return true;
      mine.lower = std::max(mine.lower, other->lower), mine.upper = std::min(mine.upper, other->upper);
      mine.plausible_lower = std::max(mine.plausible_lower, other->plausible_lower);
      mine.plausible_upper = std::min(mine.plausible_upper, other->plausible_upper);
      return false;
    });
  }
  return shared;
}

}  // namespace beamid::experiments
