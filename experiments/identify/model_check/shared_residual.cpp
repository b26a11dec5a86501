#include "experiments/identify/model_check/shared_residual.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "experiments/identify/update/updating.hpp"
#include "experiments/modal/poles.hpp"
#include "experiments/models/estimates.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using ExplanationVerdict = Explanation::Verdict;

constexpr Index large_system = 400;  // coordinates, of which a search takes seconds

// Drawn by update, no change among them.
int starts_of_search(Index coordinates) {
  return coordinates > large_system ? 2 : 4;
}

// Several changes together have several minima: every combination of no change, one half as large either way
// as is plausible, and one half as large again.
std::vector<VectorXd> grid_of_starts(const ModelCheck& check, const std::vector<std::size_t>& which,
                                     Index coordinates) {
  std::vector<VectorXd> grid{VectorXd::Zero(static_cast<Index>(which.size()))};
  if (which.size() == 1) return {};
  for (std::size_t i = 0; i < which.size(); ++i) {
    const Candidate& c = check.candidates[which[i]];
    std::vector<double> places{0.5 * c.plausible_lower, 0.5 * c.plausible_upper};
    if (coordinates <= large_system)
      places.insert(places.end(), {1.5 * c.plausible_lower, 1.5 * c.plausible_upper});
    for (std::size_t k = 0, known = grid.size(); k < known; ++k)
      for (const double place : places) {
        if (place == 0.0) continue;
        grid.push_back(grid[k]);
        grid.back()[static_cast<Index>(i)] = place;  // update keeps it within what is possible
      }
  }
  grid.erase(grid.begin());
  return grid;
}

// What the modes say of the changes.
void set_intervals(const ModelCheck& check, const SharedResidual& residual, const Updating& found,
                   Explanation& e) {
  const auto q = static_cast<Index>(e.candidates.size());
  e.deviation.resize(q), e.lower.resize(q), e.upper.resize(q);
  for (Index i = 0; i < q; ++i) {
    const Candidate& c = check.candidates[e.candidates[static_cast<std::size_t>(i)]];
    const UpdatedParameter& one = found.parameters[static_cast<std::size_t>(i)];
    e.at_limit.push_back(one.on_bound);
    e.determined.push_back(one.determined);
    e.deviation[i] = one.deviation;
    if (const double slope = found.best().fit.value.jacobian.col(i).norm();
        one.on_bound && q == 1 && slope > 0)
      e.deviation[i] = found.widening * std::abs(residual.space().slope(found.best().fit.x)[i]) / slope;
    e.lower[i] = std::max(c.lower, e.change[i] - quantile_95 * e.deviation[i]);
    e.upper[i] = std::min(c.upper, e.change[i] + quantile_95 * e.deviation[i]);
    const double most = one.determined ? e.upper[i] : e.change[i],
                 least = one.determined ? e.lower[i] : e.change[i];
    e.plausible = e.plausible && most >= c.plausible_lower && least <= c.plausible_upper;
  }
}

}  // namespace

Explanation explain(const ModelCheck& check, const std::vector<std::size_t>& which) {
  const SharedResidual residual(check, which);
  const Updating found = update(
      residual,
      {{check.settings.model_error, check.settings.shape_error}, starts_of_search(residual.model().size())},
      grid_of_starts(check, which, residual.model().size()));
  Explanation result;
  result.candidates = which;
  result.change = found.best().values;
  result.left = residual.left(found.best().fit.value);
  result.chi_square = found.best().fit.chi_square();
  result.freedom = found.freedom;
  result.starts = found.starts;
  result.reached = found.best().starts;
  if (which.size() == 2) result.correlation = found.correlation(0, 1);
  set_intervals(check, residual, found, result);
  for (std::size_t s = 1; s < found.as_well(); ++s) {
    const VectorXd apart = (found.sets[s].values - result.change).cwiseAbs();
    if ((apart.array() <= result.deviation.array()).all())
      result.reached += found.sets[s].starts;  // the same place, to what searches end at
    else if (which.size() == 1)
      result.others.push_back(found.sets[s].values[0]);
  }
  result.verdict = !found.explains()     ? ExplanationVerdict::leaves_much
                   : !found.open.empty() ? ExplanationVerdict::undetermined
                   : result.plausible    ? ExplanationVerdict::explains
                                         : ExplanationVerdict::implausible;
  return result;
}

std::pair<double, Index> described_fit(const ModelCheck& check) {
  const SharedResidual residual(check, {});
  const FitResidual::Value value = residual.at(VectorXd(), false);
  return {value.chi_square(), residual.independent(value)};
}

const char* to_string(ExplanationVerdict verdict) {
  switch (verdict) {
    case ExplanationVerdict::explains:
      return "explains";
    case ExplanationVerdict::implausible:
      return "explains, but implausible";
    case ExplanationVerdict::undetermined:
      return "not determined by these modes";
    default:
      return "does not explain";
  }
}

CauseModel::CauseModel(fem::Structure structure, int elements, std::vector<fem::Point> points,
                       std::vector<Candidate> causes, Index count)
    : structure_(std::move(structure)),
      elements_(elements),
      points_(std::move(points)),
      causes_(std::move(causes)) {
  for (const Candidate& cause : causes_) {
    Unknown unknown{cause.name, cause.unit, 0.0, cause.scale(), Form::bounded, cause.lower, cause.upper};
    unknown.quantity = cause.name;
    asked_.unknowns.push_back(std::move(unknown));
    asked_.has_prior.push_back(false);
  }
  described_ = fem::assemble(structure_, elements_, points_);
  count_ = std::min(count, described_.size());
}

fem::StructuralSystem CauseModel::assembled(const VectorXd& changes) const {
  fem::Structure there = structure_;
  for (std::size_t q = 0; q < causes_.size(); ++q)
    there = causes_[q].changed(there, changes[static_cast<Index>(q)]);
  std::vector<fem::Point> points = points_;
  if (there.is_beam()) {
    const double before = structure_.beam().length(), after = there.beam().length();
    for (fem::Point& point : points)
      point.position = point.position == before ? after : point.position * (after / before);
  }
  return fem::assemble(there, elements_, points);
}

// Central differences, of a compliance near zero by as much as it is; one-sided at the limits.
MatrixSlope CauseModel::slope(const VectorXd& changes, Index cause, Index n) const {
  const Candidate& of = causes_[static_cast<std::size_t>(cause)];
  if (of.of_clock) return {fem::SparseMatrix(n, n), fem::SparseMatrix(n, n)};
  const double scale = of.scale(), x = changes[cause],
               step = 1e-3 * std::min(scale, std::max(x - of.lower, 1e-6 * scale));
  VectorXd above = changes, below = changes;
  above[cause] = std::min(of.upper, x + step);
  below[cause] = std::max(of.lower, x - step);
  const fem::StructuralSystem more = assembled(above), less = assembled(below);
  if (more.size() != n || less.size() != n)
    throw std::runtime_error("a change of " + of.label + " changes the mesh");
  const double width = above[cause] - below[cause];
  return {(more.stiffness.assembled() - less.stiffness.assembled()) / width, (more.mass - less.mass) / width};
}

PredictedModes CauseModel::at(const VectorXd& changes, bool slopes) const {
  const fem::StructuralSystem system = causes_.empty() ? described_ : assembled(changes);
  const FoundModes found = lowest_found_modes(system, count_, slopes);
  PredictedModes modes = seen_modes(found, system.outputs, count_);
  if (slopes) {
    std::vector<MatrixSlope> changing;
    for (Index q = 0; q < changes.size(); ++q) changing.push_back(slope(changes, q, system.size()));
    add_slopes(found, system.outputs, changing, modes);
  }
  for (std::size_t q = 0; q < causes_.size(); ++q) {
    if (!causes_[q].of_clock) continue;
    const double rate = 1.0 + changes[static_cast<Index>(q)];
    if (slopes) modes.frequency_slopes *= rate;
    if (slopes) modes.frequency_slopes.col(static_cast<Index>(q)) = modes.frequency_hz;
    modes.frequency_hz *= rate;
  }
  return modes;
}

namespace {

constexpr Index spare_checked_modes = 4;  // beyond those identified, for pairing by shapes

std::vector<Candidate> causes_of(const ModelCheck& check, const std::vector<std::size_t>& which) {
  std::vector<Candidate> causes;
  for (const std::size_t c : which) causes.push_back(check.candidates[c]);
  return causes;
}

std::vector<std::pair<double, double>> plausible_ranges(const std::vector<Candidate>& causes) {
  std::vector<std::pair<double, double>> ranges;
  for (const Candidate& cause : causes) ranges.emplace_back(cause.plausible_lower, cause.plausible_upper);
  return ranges;
}

std::vector<std::unique_ptr<const CauseModel>> models_of(const ModelCheck& check,
                                                         const std::vector<Candidate>& causes) {
  std::vector<std::unique_ptr<const CauseModel>> models;
  for (std::size_t s = 0; s < check.structures.size(); ++s) {
    Index last = 0;
    for (const CheckedMode& mode : check.modes)
      if (mode.structure == s) last = std::max<Index>(last, mode.number);
    if (last == 0) continue;
    const CheckedStructure& structure = check.structures[s];
    const std::vector<fem::Point> points = points_of_shapes(structure);
    models.push_back(
        std::make_unique<const CauseModel>(structure.structure, structure.elements, points, causes,
                                           points.size() > 1 ? last + spare_checked_modes : last));
  }
  return models;
}

}  // namespace

std::vector<fem::Point> points_of_shapes(const CheckedStructure& structure) {
  const fem::Point natural = fem::natural_point(structure.structure);
  const auto& channels = structure.channels;
  const bool shaped = channels.size() > 1 && channels[0].quantity != Quantity::strain &&
                      std::all_of(channels.begin(), channels.end(),
                                  [&](const Channel& c) { return c.quantity == channels[0].quantity; });
  if (!shaped) return {natural};
  std::vector<fem::Point> points;
  for (const Channel& channel : channels)
    points.push_back({channel.name, channel.position.value_or(natural.position),
                      channel.place.empty() ? natural.place : channel.place});
  return points;
}

MeasuredMode as_measured(const ObservedMode& mode, std::size_t points, std::optional<int> number) {
  MeasuredMode measured{mode.frequency_hz,
                        std::isfinite(mode.frequency_deviation_hz) ? mode.frequency_deviation_hz : 0.0};
  if (points > 1 && mode.shape.size() == static_cast<Index>(points)) {
    measured.shape = nearest_real(mode.shape);
    measured.shape_deviation = mode.shape_deviation;
  }
  measured.number = number;
  return measured;
}

SharedResidual::SharedResidual(const ModelCheck& check, const std::vector<std::size_t>& which)
    : models_(models_of(check, causes_of(check, which))),
      space_(models_.front()->asked(), plausible_ranges(causes_of(check, which))) {
  std::size_t part = 0;
  for (std::size_t s = 0; s < check.structures.size(); ++s) {
    const std::size_t points = points_of_shapes(check.structures[s]).size();
    ModalData data{check.structures[s].name, {}};
    for (const CheckedMode& mode : check.modes)
      if (mode.structure == s)
        data.modes.push_back(
            as_measured(mode.identified, points,
                        mode.paired_by_shape() ? std::nullopt : std::optional<int>(mode.number)));
    if (!data.modes.empty())
      parts_.emplace_back(*models_[part++], space_, data,
                          ModelTrust{check.settings.model_error, check.settings.shape_error});
  }
}

FitResidual::Value SharedResidual::at(const VectorXd& x, bool jacobian) const {
  Value value;
  Index rows = 0, row = 0;
  for (const ModalResidual& part : parts_) {
    value.parts.push_back(part.at(x, jacobian));
    rows += part.size();
  }
  value.residual.resize(rows);
  if (jacobian) value.jacobian.resize(rows, x.size());
  for (Value& part : value.parts) {
    value.residual.segment(row, part.residual.size()) = part.residual;
    if (jacobian) value.jacobian.middleRows(row, part.residual.size()) = part.jacobian;
    row += part.residual.size();
  }
  return value;
}

Index SharedResidual::independent(const Value& value) const {
  Index count = 0;
  for (std::size_t p = 0; p < parts_.size(); ++p) count += parts_[p].independent(value.parts[p]);
  return count;
}

VectorXd SharedResidual::left(const Value& value) const {
  std::vector<double> left;
  for (std::size_t p = 0; p < parts_.size(); ++p)
    for (std::size_t i = 0; i < value.parts[p].pairs.size(); ++i)
      left.push_back(std::log(parts_[p].data().modes[i].frequency_hz /
                              value.parts[p].modes.frequency_hz[value.parts[p].pairs[i]]));
  return VectorXd::Map(left.data(), static_cast<Index>(left.size()));
}

MatrixXd SharedResidual::effect(const Value& value) const {
  MatrixXd effect(left(value).size(), space_.size());
  Index row = 0;
  for (const Value& part : value.parts)
    for (const Index k : part.pairs)
      effect.row(row++) = part.modes.frequency_slopes.row(k) / part.modes.frequency_hz[k];
  return effect;
}

}  // namespace beamid::experiments
