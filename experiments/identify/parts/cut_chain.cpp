#include "experiments/identify/parts/cut_chain.hpp"

#include <algorithm>
#include <cmath>

namespace beamid::experiments {
namespace {

// Of the storeys that are kept: foot of the first, top of the last [m].
struct Heights {
  double foot = 0.0, top = 0.0, slack = 0.0;

  bool hold(double from, double to) const { return from > foot - slack && to < top + slack; }
  bool miss(double from, double to) const { return to < foot + slack || from > top - slack; }
};

Heights kept_heights(const fem::Beam& chain, const PartOfStructure& part) {
  Heights kept{0.0, part.to.value_or(chain.length()), 1e-9 * chain.length()};
  double height = 0.0;
  for (const fem::Segment& storey : chain.segments) {
    if (part.from && height + storey.length < *part.from + kept.slack) kept.foot = height;
    height += storey.length;
  }
  return kept;
}

bool can_be_cut(const Experiment& experiment, const Heights& kept) {
  const fem::Beam& chain = experiment.structure.beam();
  if (!chain.added_masses.empty() || !chain.springs.empty() || !chain.dashpots.empty() ||
      !chain.absorbers.empty() || !chain.damages.empty() || chain.axial_load != 0.0)
    return false;
  return std::all_of(experiment.parameters.begin(), experiment.parameters.end(),
                     [&](const ParameterChoice& one) {
                       if (one.quantity == "stiffness_damping" || one.quantity == "mass_damping") return true;
                       if (one.quantity == "damping_ratio")
                         return true;  // which experiment_of_part() refuses
                       return one.region && (kept.hold(one.region->first, one.region->second) ||
                                             kept.miss(one.region->first, one.region->second));
                     });
}

fem::Beam cut(const fem::Beam& chain, const Heights& kept) {
  fem::Beam part = chain;
  part.segments.clear(), part.bodies.clear(), part.supports.clear();
  double height = 0.0;
  for (const fem::Segment& storey : chain.segments) {
    if (kept.hold(height, height + storey.length)) part.segments.push_back(storey);
    height += storey.length;
  }
  part.supports.push_back({0.0});
  for (fem::Support support : chain.supports) {
    support.position -= kept.foot;
    if (support.position > kept.slack && support.position < kept.top - kept.foot + kept.slack)
      part.supports.push_back(support);
  }
  for (fem::Body body : chain.bodies) {
    body.position -= kept.foot;
    if (body.position > kept.slack && body.position < kept.top - kept.foot + kept.slack)
      part.bodies.push_back(body);
  }
  return part;
}

std::optional<double> moved(const std::optional<double>& place, double foot) {
  return place ? std::optional(*place - foot) : place;
}

}  // namespace

CutChain cut_chain(const Experiment& experiment, ComparedRecord record, const PartOfStructure& part) {
  const bool chain = experiment.structure.is_chain();
  const Heights kept = chain ? kept_heights(experiment.structure.beam(), part) : Heights{};
  if (!chain || !can_be_cut(experiment, kept) || (record.truth && !record.truth->structure.is_chain()))
    return {experiment, std::move(record), part};
  CutChain result;
  result.part = part;
  result.part.from = moved(part.from, kept.foot);
  result.part.to = moved(part.to, kept.foot);
  result.record = std::move(record);
  for (Channel& channel : result.record.record.channels)
    channel.position = moved(channel.position, kept.foot);
  Experiment& own = result.experiment = experiment;
  own.structure = cut(experiment.structure.beam(), kept);
  own.parameters.clear();
  for (ParameterChoice choice : experiment.parameters) {
    if (choice.region && !kept.hold(choice.region->first, choice.region->second)) continue;
    if (choice.region) choice.region->first -= kept.foot, choice.region->second -= kept.foot;
    own.parameters.push_back(std::move(choice));
  }
  if (auto& truth = result.record.truth) truth->structure = cut(truth->structure.beam(), kept);
  return result;
}

}  // namespace beamid::experiments
