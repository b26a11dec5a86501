#include "experiments/identify/parts/parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/run_bound.hpp"
#include "reduction/reduction.hpp"

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

namespace {

// A part whose noise is larger than stated.

/// Widens the deviations of a run by sqrt(mean of innovation^T S^-1 innovation / p) where that is beyond what
/// chance allows above 1, unless they are widened as much already, and says so first among its warnings. With
/// all noise s times what was stated, that of the estimates is s times theirs: the weights stay the same.
void widen_by_innovations(ComparedRun& run) {
  if (!run.has_estimate() || !run.diagnostics || !run.diagnostics->consistency) return;
  const filters::InnovationConsistency& found = *run.diagnostics->consistency;
  if (!(found.mean_normalised_square > std::max(1.0, found.upper_95))) return;
  const double factor = std::sqrt(found.mean_normalised_square);
  for (std::size_t j = 0; j < run.parameters.size(); ++j) {
    const double deviation = factor * formal_deviation(run, j);
    if (!(deviation > run.parameters[j].estimate.deviation)) continue;
    run.parameters[j].estimate.deviation = deviation;
    set_interval(run, j, factor);
  }
  run.interval_factor = std::max(run.interval_factor, factor);
  constexpr double worth_saying = 1.1;
  if (factor > worth_saying)
    run.object(
        {"innovations",
         fmt::format(
             "The innovations are {:.3g} times as large as the stated noise makes them (mean normalised "
             "square {:.3g}): standard deviations are widened by as much.",
             factor, found.mean_normalised_square),
         found.mean_normalised_square, found.upper_95});
}

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr Eigen::Index most_whole_coordinates = 30;

// A name for every parameter, so that it means the same in every part.
void name_parameters(Experiment& experiment) {
  std::map<std::string, int> count, number;
  for (const ParameterChoice& choice : experiment.parameters)
    if (choice.name.empty()) ++count[choice.quantity];
  for (ParameterChoice& choice : experiment.parameters)
    if (choice.name.empty())
      choice.name = count[choice.quantity] > 1
                        ? fmt::format("{}_{}", choice.quantity, ++number[choice.quantity])
                        : choice.quantity;
}

Comparison identify_part(const Experiment& experiment, const ComparedRecord& record,
                         const PartOfStructure& part, Sections sections,
                         const std::filesystem::path& folder) {
  CutChain own = cut_chain(experiment, record_of_part(experiment, record, part, sections), part);
  const Experiment asked = experiment_of_part(own.experiment, own.record, own.part);
  if (has_spans(asked.structure)) return identify_span(asked, std::move(own.record), part.highest_hz);
  if (part.highest_hz)
    throw InputError(
        part.place,
        fmt::format("substructure '{}': highest_hz is of spans of a beam, which are identified by "
                    "the lines of the spectrum; this part is identified by a filter",
                    part.name));
  return compare(asked, std::move(own.record), folder, unwatched);
}

Comparison identify_whole(const Experiment& experiment, const ComparedRecord& record,
                          const std::filesystem::path& folder) {
  Experiment whole = experiment;
  whole.model = {"beam", model_registry().completed("beam", {{"sensor_bias", false}}), {}};
  whole.reduction = {"none", reduction::reduction_registry().completed("none", {}), {}};
  whole.reductions = {whole.reduction};
  whole.filters = {experiment.filter};
  whole.discretisations = {experiment.discretisation};
  return compare(whole, record, folder, unwatched);
}

// What one part says of the parameters it shares with others: places among all, values, information.
struct PartSays {
  std::vector<Index> places;
  VectorXd values;
  MatrixXd information;
};

PartSays says(const ComparedRun& run, const std::map<std::string, Index>& place_of) {
  PartSays part;
  part.values.resize(static_cast<Index>(run.parameters.size()));
  for (std::size_t j = 0; j < run.parameters.size(); ++j) {
    part.places.push_back(place_of.at(run.parameters[j].estimate.name));
    part.values[static_cast<Index>(j)] = run.parameters[j].estimate.value;
  }
  const MatrixXd covariance = covariance_of_parameters(run);
  part.information = covariance.ldlt().solve(MatrixXd::Identity(covariance.rows(), covariance.cols()));
  return part;
}

// theta = I^-1 sum_p E_p^T P_p^-1 theta_p, I = sum_p E_p^T P_p^-1 E_p over the parts p, E_p picking theirs.
void join_with_covariances(const std::vector<PartSays>& parts, std::vector<JoinedParameter>& all) {
  const auto q = static_cast<Index>(all.size());
  VectorXd scale(q), weighed = VectorXd::Zero(q);
  for (Index j = 0; j < q; ++j) scale[j] = all[static_cast<std::size_t>(j)].deviation;
  std::vector<Eigen::Triplet<double>> entries;
  for (const PartSays& part : parts) {
    const VectorXd own = scale(part.places);
    const MatrixXd information = own.asDiagonal() * part.information * own.asDiagonal();
    weighed(part.places) += information * part.values.cwiseQuotient(own);
    for (Index i = 0; i < information.rows(); ++i)
      for (Index j = 0; j < information.cols(); ++j)
        entries.emplace_back(static_cast<int>(part.places[static_cast<std::size_t>(i)]),
                             static_cast<int>(part.places[static_cast<std::size_t>(j)]), information(i, j));
  }
  Eigen::SparseMatrix<double> information(q, q);
  information.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(information);
  if (factor.info() != Eigen::Success) return;  // as weighed by the variances alone
  const VectorXd found = factor.solve(weighed);
  for (Index j = 0; j < q; ++j) {
    JoinedParameter& one = all[static_cast<std::size_t>(j)];
    one.value = scale[j] * found[j];
    one.deviation = scale[j] * std::sqrt(factor.solve(VectorXd::Unit(q, j).eval())[j]);
  }
}

std::vector<JoinedParameter> joined(const Experiment& experiment, const std::vector<IdentifiedPart>& parts) {
  std::map<std::string, std::vector<const ComparedParameter*>> found;
  for (const IdentifiedPart& part : parts) {
    if (!part.converged()) continue;
    for (const ComparedParameter& parameter : part.run(Sections::noisy).parameters)
      found[parameter.estimate.name].push_back(&parameter);
  }
  std::vector<JoinedParameter> all;
  std::map<std::string, Index> place_of;
  for (const ParameterChoice& choice : experiment.parameters) {
    const auto same = found.find(choice.name);
    if (same == found.end()) continue;
    JoinedParameter one{choice.name, {}, 0.0, 0.0, 0, 0.0, {}};
    double weights = 0.0;
    for (const ComparedParameter* const parameter : same->second) {
      const double weight = 1.0 / (parameter->estimate.deviation * parameter->estimate.deviation);
      one.value += weight * parameter->estimate.value;
      weights += weight;
      one.unit = parameter->estimate.unit;
      one.truth = parameter->truth;
      ++one.parts;
      for (const ComparedParameter* const other : same->second)
        one.disagreement = std::max(one.disagreement,
                                    std::abs(other->estimate.value - parameter->estimate.value) /
                                        std::hypot(other->estimate.deviation, parameter->estimate.deviation));
    }
    one.value /= weights;
    one.deviation = 1.0 / std::sqrt(weights);
    place_of[one.name] = static_cast<Index>(all.size());
    all.push_back(one);
  }
  std::vector<PartSays> say;
  for (const IdentifiedPart& part : parts)
    if (part.converged()) say.push_back(says(part.run(Sections::noisy), place_of));
  if (!all.empty()) join_with_covariances(say, all);
  return all;
}

}  // namespace

bool PartedIdentification::converged() const {
  return std::all_of(parts.begin(), parts.end(), [](const IdentifiedPart& one) { return one.converged(); });
}

ComparedRecord simulated_for_parts(const Experiment& truth, const std::filesystem::path& folder,
                                   const Progress& progress) {
  if (has_spans(truth.structure))
    throw InputError(
        truth.parts.front().place,
        "a span is identified from a RECORD without aliases; expected one, as of beamid simulate with "
        "[simulation] modes far above and a rate several times that of [[record.prepare]] step = "
        "\"decimate\"");
  return simulated_record(truth, folder, progress);
}

PartedIdentification identify_parts(const Experiment& given, const ComparedRecord& record,
                                    const std::filesystem::path& folder, bool whole,
                                    const Progress& progress) {
  Experiment experiment = given;
  name_parameters(experiment);
  ComparedRecord placed = record;
  placed.record = with_places(record.record, experiment);
  PartedIdentification result;
  for (const PartOfStructure& part : experiment.parts) result.parts.push_back({part, {}, {}});
  progress("parts");
  tbb::parallel_for(std::size_t{0}, 2 * result.parts.size(), [&](std::size_t i) {
    IdentifiedPart& one = result.parts[i / 2];
    if (i % 2 == 0)
      one.exact = identify_part(experiment, placed, one.part, Sections::exact, folder);
    else
      one.noisy = identify_part(experiment, placed, one.part, Sections::noisy, folder);
  });
  for (IdentifiedPart& one : result.parts) widen_by_innovations(one.noisy.runs.front());
  result.joined = joined(experiment, result.parts);
  const Eigen::Index coordinates = fem::assemble(experiment.structure, experiment.elements).size();
  if (whole && coordinates > most_whole_coordinates) {
    result.no_whole =
        fmt::format("The whole has {} coordinates: beyond {} it is not identified beside its parts.",
                    coordinates, most_whole_coordinates);
  } else if (whole) {
    progress("the whole");
    result.whole = identify_whole(experiment, placed, folder);
  }
  return result;
}

}  // namespace beamid::experiments
