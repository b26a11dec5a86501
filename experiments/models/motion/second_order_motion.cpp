#include "experiments/models/motion/second_order_motion.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "experiments/models/motion/second_order_step.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

SecondOrderMotion::SecondOrderMotion(MotionDescription description, MatrixXd rows, std::string name)
    : description_(std::move(description)),
      rows_(std::move(rows)),
      name_(std::move(name)),
      layout_(experiments::layout(description_, rows_.cols())) {
  if (rows_.rows() != static_cast<Index>(description_.observations.size()))
    throw std::invalid_argument(fmt::format("{} output rows for {} observations; expected one each",
                                            rows_.rows(), description_.observations.size()));
  for (const Observation& observation : description_.observations) reads(observation.quantity);
}

std::vector<filters::Label> SecondOrderMotion::state_labels() const {
  return experiments::state_labels(description_, layout_, name_);
}

std::vector<filters::Label> SecondOrderMotion::output_labels() const {
  return experiments::output_labels(description_);
}

void SecondOrderMotion::motion_matrix(const VectorXd& state, MatrixXd& matrix) const {
  const Index r = layout_.coordinates;
  SecondOrderForm form;
  evaluate(state, form, nullptr);
  matrix.setZero(layout_.motion, layout_.motion);
  matrix.block(0, r, r, r).setIdentity();
  matrix.block(r, 0, r, r) = -form.stiffness;
  matrix.block(r, r, r, r) = -form.damping;
  for (std::size_t i = 0; i < layout_.drifts.size(); ++i)
    if (layout_.drifts[i] >= 0) matrix(layout_.biases[i], layout_.drifts[i]) = 1.0;
}

void SecondOrderMotion::motion_matrix_derivative(const VectorXd& state, Index j, MatrixXd& matrix) const {
  const Index r = layout_.coordinates;
  matrix.setZero(layout_.motion, layout_.motion);
  if (j >= static_cast<Index>(description_.unknowns.size())) return;  // a constant bias
  SecondOrderForm form;
  std::vector<SecondOrderForm> slopes;
  evaluate(state, form, &slopes);
  matrix.block(r, 0, r, r) = -slopes[static_cast<std::size_t>(j)].stiffness;
  matrix.block(r, r, r, r) = -slopes[static_cast<std::size_t>(j)].damping;
}

void SecondOrderMotion::input_matrix(const VectorXd& state, MatrixXd& matrix) const {
  matrix.setZero(layout_.motion, input_size());
  if (matrix.cols() == 0) return;
  SecondOrderForm form;
  evaluate(state, form, nullptr);
  matrix.middleRows(layout_.coordinates, layout_.coordinates) = form.inputs;
}

void SecondOrderMotion::input_matrix_derivative(const VectorXd& state, Index j, MatrixXd& matrix) const {
  matrix.setZero(layout_.motion, input_size());
  if (matrix.cols() == 0 || j >= static_cast<Index>(description_.unknowns.size())) return;
  SecondOrderForm form;
  std::vector<SecondOrderForm> slopes;
  evaluate(state, form, &slopes);
  matrix.middleRows(layout_.coordinates, layout_.coordinates) = slopes[static_cast<std::size_t>(j)].inputs;
}

void SecondOrderMotion::read(const VectorXd& state, const VectorXd& input, const SecondOrderForm& form,
                             VectorXd& output) const {
  const Index r = layout_.coordinates;
  const auto z = state.head(r), rates = state.segment(r, r);
  const MatrixXd& rows = form.rows.size() > 0 ? form.rows : rows_;
  VectorXd accelerations;
  output.resize(rows.rows());
  for (Index i = 0; i < rows.rows(); ++i) {
    switch (reads(description_.observations[static_cast<std::size_t>(i)].quantity)) {
      case Reads::coordinates:
        output[i] = rows.row(i).dot(z);
        break;
      case Reads::rates:
        output[i] = rows.row(i).dot(rates);
        break;
      case Reads::accelerations:
        if (accelerations.size() == 0) {
          accelerations = -(form.stiffness * z + form.damping * rates);
          if (input.size() > 0) accelerations += form.inputs * input.head(form.inputs.cols());
        }
        output[i] = rows.row(i).dot(accelerations);
        if (description_.carried.size() > 0 && input.size() > 0)
          output[i] += description_.carried.row(i).dot(input.head(input_size()));
        if (const Index bias = layout_.biases[static_cast<std::size_t>(i)]; bias >= 0)
          output[i] += state[bias];
        break;
    }
  }
}

void SecondOrderMotion::read_jacobian(const VectorXd& state, const VectorXd& input,
                                      const SecondOrderForm& form, const std::vector<SecondOrderForm>& slopes,
                                      MatrixXd& jacobian) const {
  const Index r = layout_.coordinates;
  const auto z = state.head(r), rates = state.segment(r, r);
  const MatrixXd& rows = form.rows.size() > 0 ? form.rows : rows_;
  MatrixXd by_unknowns;
  jacobian.setZero(rows.rows(), layout_.size);
  for (Index i = 0; i < rows.rows(); ++i) {
    switch (reads(description_.observations[static_cast<std::size_t>(i)].quantity)) {
      case Reads::coordinates:
        jacobian.row(i).head(r) = rows.row(i);
        break;
      case Reads::rates:
        jacobian.row(i).segment(r, r) = rows.row(i);
        break;
      case Reads::accelerations:
        if (by_unknowns.size() == 0 && !slopes.empty()) {
          by_unknowns.resize(r, static_cast<Index>(slopes.size()));
          for (std::size_t j = 0; j < slopes.size(); ++j) {
            auto column = by_unknowns.col(static_cast<Index>(j));
            column.noalias() = -(slopes[j].stiffness * z);
            column.noalias() -= slopes[j].damping * rates;
            if (input.size() > 0) column.noalias() += slopes[j].inputs * input.head(input_size());
          }
        }
        jacobian.row(i).head(r).noalias() = -(rows.row(i) * form.stiffness);
        jacobian.row(i).segment(r, r).noalias() = -(rows.row(i) * form.damping);
        if (!slopes.empty())
          jacobian.row(i).segment(layout_.unknowns, by_unknowns.cols()).noalias() = rows.row(i) * by_unknowns;
        if (const Index bias = layout_.biases[static_cast<std::size_t>(i)]; bias >= 0)
          jacobian(i, bias) = 1.0;
        break;
    }
  }
  if (form.rows.size() == 0 || slopes.empty()) return;
  VectorXd accelerations = -(form.stiffness * z + form.damping * rates);
  if (input.size() > 0) accelerations += form.inputs * input.head(form.inputs.cols());
  for (Index i = 0; i < rows.rows(); ++i)
    for (std::size_t j = 0; j < slopes.size(); ++j) {
      const auto turned = slopes[j].rows.row(i);
      double& entry = jacobian(i, layout_.unknowns + static_cast<Index>(j));
      switch (reads(description_.observations[static_cast<std::size_t>(i)].quantity)) {
        case Reads::coordinates:
          entry += turned.dot(z);
          break;
        case Reads::rates:
          entry += turned.dot(rates);
          break;
        case Reads::accelerations:
          entry += turned.dot(accelerations);
          break;
      }
    }
}

void SecondOrderMotion::output(const VectorXd& state, const VectorXd& input, VectorXd& output) const {
  SecondOrderForm form;
  evaluate(state, form, nullptr);
  read(state, input, form, output);
}

void SecondOrderMotion::output_jacobian(const VectorXd& state, const VectorXd& input,
                                        MatrixXd& jacobian) const {
  SecondOrderForm form;
  std::vector<SecondOrderForm> slopes;
  evaluate(state, form, &slopes);
  read_jacobian(state, input, form, slopes, jacobian);
}

std::unique_ptr<filters::DiscreteModel> SecondOrderMotion::structured(double dt, const std::string& scheme,
                                                                      const filters::Noise& noise) const {
  return second_order_step(copy(), dt, scheme, noise);
}

}  // namespace beamid::experiments
