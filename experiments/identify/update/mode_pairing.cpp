#include "experiments/identify/update/mode_pairing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/QR>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Cosine squared between a shape and a space.
double share_in(const VectorXd& shape, const MatrixXd& space) {
  const VectorXd nearest = space * space.colPivHouseholderQr().solve(shape);
  return nearest.squaredNorm() / shape.squaredNorm();
}

}  // namespace

// Rows enter one by one; potentials keep every reduced cost non-negative.
std::vector<Index> best_assignment(const MatrixXd& scores) {
  const Index rows = scores.rows(), columns = scores.cols();
  VectorXd row_potential = VectorXd::Zero(rows + 1), column_potential = VectorXd::Zero(columns + 1);
  std::vector<Index> row_of(static_cast<std::size_t>(columns) + 1, 0);  // from 1; 0: free
  for (Index row = 1; row <= rows; ++row) {
    row_of[0] = row;
    Index column = 0;
    VectorXd least = VectorXd::Constant(columns + 1, std::numeric_limits<double>::infinity());
    std::vector<Index> before(static_cast<std::size_t>(columns) + 1, 0);
    std::vector<bool> used(static_cast<std::size_t>(columns) + 1, false);
    do {
      used[static_cast<std::size_t>(column)] = true;
      const Index at = row_of[static_cast<std::size_t>(column)];
      double step = std::numeric_limits<double>::infinity();
      Index next = 0;
      for (Index c = 1; c <= columns; ++c) {
        if (used[static_cast<std::size_t>(c)]) continue;
        const double cost = -scores(at - 1, c - 1) - row_potential[at] - column_potential[c];
        if (cost < least[c]) least[c] = cost, before[static_cast<std::size_t>(c)] = column;
        if (least[c] < step) step = least[c], next = c;
      }
      for (Index c = 0; c <= columns; ++c)
        if (used[static_cast<std::size_t>(c)])
          row_potential[row_of[static_cast<std::size_t>(c)]] += step, column_potential[c] -= step;
        else
          least[c] -= step;
      column = next;
    } while (row_of[static_cast<std::size_t>(column)] != 0);
    for (; column != 0; column = before[static_cast<std::size_t>(column)])
      row_of[static_cast<std::size_t>(column)] =
          row_of[static_cast<std::size_t>(before[static_cast<std::size_t>(column)])];
  }
  std::vector<Index> assigned(static_cast<std::size_t>(rows), 0);
  for (Index c = 1; c <= columns; ++c)
    if (row_of[static_cast<std::size_t>(c)] > 0)
      assigned[static_cast<std::size_t>(row_of[static_cast<std::size_t>(c)] - 1)] = c - 1;
  return assigned;
}

MatrixXd modal_assurances(const ModalData& data, const PredictedModes& modes) {
  const auto count = static_cast<Index>(data.modes.size());
  MatrixXd assurance =
      MatrixXd::Constant(count, modes.frequency_hz.size(), std::numeric_limits<double>::quiet_NaN());
  for (Index i = 0; i < count; ++i) {
    const VectorXd& shape = data.modes[static_cast<std::size_t>(i)].shape;
    if (shape.size() < 2 || shape.size() != modes.shapes.rows()) continue;
    for (Index k = 0; k < assurance.cols(); ++k) {
      const auto [first, number] = modes.cluster[static_cast<std::size_t>(k)];
      assurance(i, k) = number < shape.size() ? share_in(shape, modes.shapes.middleCols(first, number))
                                              : share_in(shape, modes.shapes.col(k));
    }
  }
  return assurance;
}

MatrixXd pairing_scores(const ModalData& data, const PredictedModes& modes, const MatrixXd& assurances) {
  MatrixXd scores(assurances.rows(), assurances.cols());
  for (Index i = 0; i < scores.rows(); ++i)
    for (Index k = 0; k < scores.cols(); ++k) {
      const double measured = data.modes[static_cast<std::size_t>(i)].frequency_hz;
      scores(i, k) = -std::abs(std::log(measured / std::max(modes.frequency_hz[k], 1e-300)));
      if (std::isfinite(assurances(i, k))) scores(i, k) += assurances(i, k);
    }
  return scores;
}

std::vector<Index> pair_modes(const ModalData& data, const PredictedModes& modes) {
  const auto count = static_cast<Index>(data.modes.size());
  const bool numbered = std::any_of(data.modes.begin(), data.modes.end(),
                                    [](const MeasuredMode& mode) { return mode.number.has_value(); });
  std::vector<Index> pairs(static_cast<std::size_t>(count));
  if (!data.has_shapes() && !numbered) {
    for (Index i = 0; i < count; ++i) pairs[static_cast<std::size_t>(i)] = i;
    return pairs;
  }
  constexpr double certain = 1e6;
  MatrixXd scores = pairing_scores(data, modes, modal_assurances(data, modes));
  for (Index i = 0; i < count; ++i)
    if (const std::optional<int>& number = data.modes[static_cast<std::size_t>(i)].number)
      for (Index k = 0; k < scores.cols(); ++k) scores(i, k) = *number == k + 1 ? certain : -certain;
  return best_assignment(scores);
}

}  // namespace beamid::experiments
