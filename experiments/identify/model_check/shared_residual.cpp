#include "experiments/identify/model_check/shared_residual.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/modal/nearest_real.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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
