#include "experiments/models/motion/rational_step.hpp"

#include <cmath>
#include <stdexcept>

#include "filters/step_input.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Up to this 1-norm an approximant of the degree is the exponential to rounding [higham2005, table 2.3].
struct Degree {
  double largest_norm;
  std::vector<double> coefficients;  // b_0 .. b_m
};

const std::vector<Degree>& pade_degrees() {
  static const std::vector<Degree> known{
      {1.495585217958292e-2, {120, 60, 12, 1}},
      {2.539398330063230e-1, {30240, 15120, 3360, 420, 30, 1}},
      {9.504178996162932e-1, {17297280, 8648640, 1995840, 277200, 25200, 1512, 56, 1}},
      {2.097847961257068,
       {17643225600, 8821612800, 2075673600, 302702400, 30270240, 2162160, 110880, 3960, 90, 1}},
      {5.371920351148152,
       {64764752532480000, 32382376266240000, 7771770303897600, 1187353796428800, 129060195264000,
        10559470521600, 670442572800, 33522128640, 1323241920, 40840800, 960960, 16380, 182, 1}}};
  return known;
}

}  // namespace

RationalStep::RationalStep(Scheme scheme, double dt, const VectorXd& frequencies)
    : scheme_(scheme), dt_(dt), r_(frequencies.size()), size_(2 * r_) {
  scale_.setOnes(2 * r_ + filters::StepInput::highest_degree + 1);
  scale_.head(r_) = frequencies;
}

MatrixXd RationalStep::chain_of(const VectorXd& input, Index inputs) const {
  const filters::StepInput path(input, inputs);
  if (path.size() == 0) return {};
  if (path.degree() == 0) return path.coefficient(0);
  if (scheme_ == Scheme::pade) {
    MatrixXd chain(path.size(), 2);
    chain.col(1) = path.slope();
    chain.col(0) = path.mean() - 0.5 * chain.col(1);
    return chain;
  }
  MatrixXd chain(path.size(), path.degree() + 1);
  double factorial = 1.0;
  for (Index j = 0; j < chain.cols(); ++j) {
    if (j > 1) factorial *= static_cast<double>(j);
    chain.col(j) = factorial * path.coefficient(j);
  }
  return chain;
}

void RationalStep::choose_degree(double norm) {
  squarings_ = 0;
  if (!std::isfinite(norm)) throw std::runtime_error("the equations of motion are not finite");
  if (scheme_ == Scheme::pade) {
    coefficients_ = {12, 6, 1};
    return;
  }
  for (const Degree& degree : pade_degrees())
    if (norm <= degree.largest_norm) {
      coefficients_ = degree.coefficients;
      return;
    }
  constexpr int most_squarings = 12;
  coefficients_ = pade_degrees().back().coefficients;
  const double halvings = std::ceil(std::log2(norm / pade_degrees().back().largest_norm));
  if (halvings > most_squarings)
    throw std::runtime_error("the fastest motion turns too far within one interval for its exponential");
  squarings_ = static_cast<int>(halvings);
}

void RationalStep::set(const SecondOrderForm& form, MatrixXd chain_of_inputs) {
  chain_ = std::move(chain_of_inputs);
  has_whole_slopes_ = false;
  size_ = 2 * r_ + chain_.cols();
  if (scale_.size() < size_) scale_.conservativeResize(size_);
  const auto scale = scale_.head(r_);
  x_.setZero(size_, size_);
  x_.block(0, r_, r_, r_).diagonal() = dt_ * scale;
  x_.block(r_, 0, r_, r_).noalias() = -dt_ * form.stiffness * scale.cwiseInverse().asDiagonal();
  x_.block(r_, r_, r_, r_) = -dt_ * form.damping;
  if (const Index chain = chain_.cols(); chain > 0) {
    // Each power of the step is smaller than the one before, as those of smooth inputs are.
    constexpr double pace = 0.2;
    auto pushes = x_.block(r_, 2 * r_, r_, chain);
    pushes.noalias() = dt_ * (form.inputs * chain_);
    double first = 0.0;
    for (Index j = chain - 1; j >= 0; --j)
      first = std::max(pushes.col(j).cwiseAbs().maxCoeff(), first / pace);
    first = first > 0.0 ? first / (dt_ * scale.maxCoeff()) : 1.0;
    for (Index j = 0; j < chain; ++j) {
      scale_[2 * r_ + j] = first * std::pow(pace, j);
      pushes.col(j) /= scale_[2 * r_ + j];
      if (j > 0) x_(2 * r_ + j, 2 * r_ + j - 1) = pace;
    }
  }
  choose_degree(x_.cwiseAbs().colwise().sum().maxCoeff());
  x_ *= std::ldexp(1.0, -squarings_);

  // Even and odd parts by the powers of X^2 up to X^6, those beyond taken times X^6 [higham2005].
  const auto b = [&](std::size_t k) { return k < coefficients_.size() ? coefficients_[k] : 0.0; };
  const std::size_t degree = coefficients_.size() - 1;
  even_.setZero(size_, size_);
  odd_.setZero(size_, size_);
  even_.diagonal().setConstant(b(0));
  odd_.diagonal().setConstant(b(1));
  square_.noalias() = x_ * x_;
  power_ = square_;
  MatrixXd& beyond_even = below_;
  MatrixXd& beyond_odd = step_;
  beyond_even.setZero(size_, size_);
  beyond_odd.setZero(size_, size_);
  for (std::size_t k = 2; k <= std::min<std::size_t>(degree, 6); k += 2) {
    if (k > 2) {
      spare_.noalias() = power_ * square_;
      power_.swap(spare_);
    }
    even_ += b(k) * power_;
    odd_ += b(k + 1) * power_;
    beyond_even += b(k + 6) * power_;
    beyond_odd += b(k + 7) * power_;
  }
  if (degree > 7) {
    even_.noalias() += power_ * beyond_even;
    odd_.noalias() += power_ * beyond_odd;
  }
  spare_.noalias() = x_ * odd_;
  odd_.swap(spare_);
  below_ = even_ - odd_;
  factor_.compute(below_);
  step_ = factor_.solve(2.0 * odd_);  // R - I
  step_.diagonal().array() += 1.0;
  whole_ = step_;
  for (int k = 0; k < squarings_; ++k) {
    spare_.noalias() = whole_ * whole_;
    whole_.swap(spare_);
  }
}

void RationalStep::apply(const VectorXd& state, VectorXd& next) const {
  VectorXd scaled = VectorXd::Zero(size_);
  scaled.head(2 * r_) = scale_.head(2 * r_).cwiseProduct(state.head(2 * r_));
  if (size_ > 2 * r_) scaled[2 * r_] = scale_[2 * r_];
  next.head(2 * r_).noalias() = whole_.topRows(2 * r_) * scaled;
  next.head(2 * r_).array() /= scale_.head(2 * r_).array();
}

void RationalStep::tangent(Eigen::Ref<MatrixXd> matrix) const {
  const auto scale = scale_.head(2 * r_);
  matrix = scale.cwiseInverse().asDiagonal() * whole_.topLeftCorner(2 * r_, 2 * r_) * scale.asDiagonal();
}

// Of v in n columns and w = R v: dR v for every slope, one block of columns after another, in moved_.
void RationalStep::derive(const Eigen::Ref<const MatrixXd>& v, const Eigen::Ref<const MatrixXd>& w,
                          const std::vector<SecondOrderForm>& slopes) {
  const auto q = static_cast<Index>(slopes.size()), n = v.cols();
  const auto degree = static_cast<Index>(coefficients_.size()) - 1;
  // c_i, a block of columns each
  terms_.resize(size_, degree * n);
  for (Index i = degree; i > 0; --i) {
    auto c = terms_.middleCols((i - 1) * n, n);
    const double b = coefficients_[static_cast<std::size_t>(i)];
    if (i % 2 == 1)
      c = b * (v + w);
    else
      c = b * (v - w);
    if (i < degree) c.noalias() += x_ * terms_.middleCols(i * n, n);
  }

  // dX c_i has entries in the rows of z'' only
  const double h = dt_ * std::ldexp(1.0, -squarings_);
  forced_.resize(r_, q * degree * n);
  slope_.resize(r_, size_);
  for (Index j = 0; j < q; ++j) {
    const SecondOrderForm& form = slopes[static_cast<std::size_t>(j)];
    slope_.leftCols(r_).noalias() = -h * form.stiffness * scale_.head(r_).cwiseInverse().asDiagonal();
    slope_.middleCols(r_, r_) = -h * form.damping;
    if (size_ > 2 * r_)
      slope_.rightCols(chain_.cols()).noalias() =
          h * (form.inputs * chain_) * scale_.segment(2 * r_, chain_.cols()).cwiseInverse().asDiagonal();
    forced_.middleCols(j * degree * n, degree * n).noalias() = slope_ * terms_;
  }
  moved_.setZero(size_, q * n);
  for (Index i = degree - 1; i >= 0; --i) {
    if (i < degree - 1) {
      spare_.noalias() = x_ * moved_;
      moved_.swap(spare_);
    }
    for (Index j = 0; j < q; ++j)
      moved_.block(r_, j * n, r_, n) += forced_.middleCols((j * degree + i) * n, n);
  }
  moved_ = factor_.solve(moved_);
}

void RationalStep::tangent_by_unknowns(const VectorXd& state, const std::vector<SecondOrderForm>& slopes,
                                       Eigen::Ref<MatrixXd> matrix) {
  const auto q = static_cast<Index>(slopes.size());
  if (q == 0) return;
  const Index substeps = Index{1} << squarings_;
  VectorXd scaled = VectorXd::Zero(size_);
  scaled.head(2 * r_) = scale_.head(2 * r_).cwiseProduct(state.head(2 * r_));
  if (size_ > 2 * r_) scaled[2 * r_] = scale_[2 * r_];
  if (substeps > size_) {  // fewer columns are all of dR, which are squared along with R
    derive_whole(slopes);
    for (Index j = 0; j < q; ++j)
      matrix.col(j) = (whole_slopes_.middleCols(j * size_, size_).topRows(2 * r_) * scaled)
                          .cwiseQuotient(scale_.head(2 * r_));
    return;
  }
  states_.resize(size_, substeps + 1);
  states_.col(0) = scaled;
  for (Index k = 0; k < substeps; ++k) states_.col(k + 1).noalias() = step_ * states_.col(k);
  derive(states_.leftCols(substeps), states_.rightCols(substeps), slopes);
  for (Index j = 0; j < q; ++j) {
    for (Index k = 1; k < substeps; ++k)
      moved_.col(j * substeps + k) += step_ * moved_.col(j * substeps + k - 1);
    matrix.col(j) = moved_.col((j + 1) * substeps - 1).head(2 * r_).cwiseQuotient(scale_.head(2 * r_));
  }
}

void RationalStep::derive_whole(const std::vector<SecondOrderForm>& slopes) {
  if (has_whole_slopes_) return;
  derive(MatrixXd::Identity(size_, size_), step_, slopes);
  MatrixXd power = step_;
  for (int k = 0; k < squarings_; ++k) {  // d(R R) = R dR + dR R
    spare_.noalias() = power * moved_;
    for (Index j = 0; j < static_cast<Index>(slopes.size()); ++j)
      spare_.middleCols(j * size_, size_).noalias() += moved_.middleCols(j * size_, size_) * power;
    moved_.swap(spare_);
    power = (power * power).eval();
  }
  whole_slopes_ = moved_;
  has_whole_slopes_ = true;
}

}  // namespace beamid::experiments
