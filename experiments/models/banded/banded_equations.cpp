#include "experiments/models/banded/banded_equations.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <string>

#include "experiments/models/banded/banded_blocks.hpp"

namespace beamid::experiments::banded {

using Eigen::Index, Eigen::VectorXd;

ParametricRows::ParametricRows(const fem::SparseMatrix& reference,
                               const std::vector<const fem::SparseMatrix*>& slopes) {
  fem::SparseMatrix sum = reference;  // with places for all that is added later
  for (const fem::SparseMatrix* slope : slopes)
    if (slope->nonZeros() > 0) sum += 0.0 * *slope;
  reference_ = now_ = SparseRows(sum);
  for (const fem::SparseMatrix* slope : slopes) {
    slopes_.emplace_back(slope->nonZeros() > 0 ? *slope : fem::SparseMatrix(sum.rows(), sum.cols()));
    entries_.push_back(now_.entries_of(*slope));
    Index first = sum.cols(), last = 0;
    for (int j = 0; j < slope->outerSize(); ++j)
      if (slope->col(j).nonZeros() > 0) first = std::min<Index>(first, j), last = j + 1;
    reaches_.emplace_back(std::min(first, last), last);
  }
}

void ParametricRows::set(const Eigen::VectorXd& change) {
  if (std::all_of(entries_.begin(), entries_.end(), [](const EntryList& one) { return one.place.empty(); }))
    return;
  now_.values() = reference_.values();
  for (std::size_t j = 0; j < entries_.size(); ++j)
    entries_[j].add(change[static_cast<Index>(j)], now_.values());
}

namespace {

// First strain of each block: where no entry of any of the matrices reaches across. The last is the number of
// strains.
std::vector<int> block_starts(const std::vector<const fem::SparseMatrix*>& rigidities) {
  const auto strains = static_cast<int>(rigidities.empty() ? 0 : rigidities.front()->rows());
  std::vector<int> last(strains);  // strain that each is coupled to
  for (int i = 0; i < strains; ++i) last[i] = i;
  for (const fem::SparseMatrix* matrix : rigidities)
    for (int j = 0; j < matrix->outerSize(); ++j)
      for (fem::SparseMatrix::InnerIterator it(*matrix, j); it; ++it) {
        const int low = std::min(static_cast<int>(it.row()), j);
        last[low] = std::max({last[low], static_cast<int>(it.row()), j});
      }
  std::vector<int> starts;
  for (int i = 0, end = -1; i < strains; ++i) {
    if (i > end) starts.push_back(i);
    end = std::max(end, last[i]);
  }
  starts.push_back(strains);
  return starts;
}

int largest_block(const std::vector<int>& starts) {
  int largest = 0;
  for (std::size_t b = 0; b + 1 < starts.size(); ++b) largest = std::max(largest, starts[b + 1] - starts[b]);
  return largest;
}

bool are_equal(const fem::SparseMatrix& a, const fem::SparseMatrix& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && (a - b).squaredNorm() == 0.0;
}

}  // namespace

BandedStiffness::BandedStiffness(const fem::ParametricSystem& equations) {
  const fem::StrainFactors& own = equations.system.stiffness;
  std::vector<const fem::SparseMatrix*> rigidities;
  for (const auto& slope : equations.derivatives) rigidities.push_back(&slope.rigidity);
  const bool shared = rigidities.empty() || are_equal(equations.strain, own.strain);
  if (shared) rigidities.push_back(&own.rigidity);
  const std::vector<int> starts = block_starts(rigidities);
  const std::vector<int> own_starts = shared ? starts : block_starts({&own.rigidity});
  const bool small =
      std::max(largest_block(starts), largest_block(own_starts)) <= StrainProduct::largest_block;
  form_ = !small ? Form::rows : shared ? Form::one_set_of_strains : Form::two_sets;
  if (form_ == Form::rows)
    take_rows(equations);
  else
    take_strains(equations, own_starts, starts);
}

void BandedStiffness::take_strains(const fem::ParametricSystem& equations, const std::vector<int>& own_starts,
                                   const std::vector<int>& starts) {
  const fem::StrainFactors& own = equations.system.stiffness;
  fem::SparseMatrix rigidity = own.rigidity;  // with places for what is added later
  if (form_ == Form::one_set_of_strains)
    for (const auto& slope : equations.derivatives) rigidity += 0.0 * slope.rigidity;
  reference_ = StrainProduct(own.strain, rigidity, own_starts);
  for (const auto& slope : equations.derivatives)
    slopes_.emplace_back(equations.strain, slope.rigidity, starts);
  current_ = {reference_};
  if (form_ == Form::two_sets) current_.insert(current_.end(), slopes_.begin(), slopes_.end());
  set(Eigen::VectorXd::Zero(static_cast<Index>(slopes_.size())));
}

void BandedStiffness::take_rows(const fem::ParametricSystem& equations) {
  const fem::StrainFactors& own = equations.system.stiffness;
  std::vector<fem::SparseMatrix> slopes;
  std::vector<const fem::SparseMatrix*> all;
  for (const auto& slope : equations.derivatives)
    slopes.push_back(assembled_stiffness(equations.strain, slope.rigidity));
  for (const fem::SparseMatrix& slope : slopes) all.push_back(&slope);
  rows_ = ParametricRows(assembled_stiffness(own.strain, own.rigidity), all);
}

void BandedStiffness::set(const Eigen::VectorXd& change) {
  if (form_ == Form::rows) return rows_.set(change);
  current_[0].take_rigidity(reference_);
  for (std::size_t j = 0; j < slopes_.size(); ++j) {
    const double by = change[static_cast<Index>(j)];
    if (form_ == Form::one_set_of_strains) {
      if (by != 0.0) current_[0].add(by, slopes_[j]);
      continue;
    }
    current_[j + 1].take_rigidity(slopes_[j]);
    current_[j + 1].add(by - 1.0, slopes_[j]);  // D_j + (change_j - 1) D_j
  }
}

namespace {

constexpr int plain_width = 3;  // of an Euler-Bernoulli beam

// use(i, (M x)_i) of every row.
template <class Entry, class Use>
[[gnu::always_inline]] inline void multiply_band(const double* band, Index size, int width, const Entry* x,
                                                 const Use& use) {
  const auto row_product = [&](Index i, Index from, Index to) {
    const double* const row = band + i * (2 * width + 1) + width - i;
    Entry sum{};
    for (Index j = from; j < to; ++j) sum += row[j] * x[j];
    use(i, sum);
  };
  const Index edge = std::min<Index>(width, size);
  for (Index i = 0; i < edge; ++i) row_product(i, 0, std::min<Index>(size, i + width + 1));
  for (Index i = edge; i < size - width; ++i) {
    const double* const row = band + i * (2 * width + 1);
    const Entry* const start = x + (i - width);
    Entry sum = row[0] * start[0];
#pragma GCC unroll 8
    for (int k = 1; k <= 2 * width; ++k) sum += row[k] * start[k];
    use(i, sum);
  }
  for (Index i = std::max(edge, size - width); i < size; ++i) row_product(i, i - width, size);
}

BEAMID_WIDE_CLONE void multiply_lanes(const double* band, Index size, int width, const Lanes* x, Lanes* y) {
  const auto set = [y](Index i, const Lanes& sum) { y[i] = sum; };
  if (width == plain_width)
    multiply_band(band, size, plain_width, x, set);
  else
    multiply_band(band, size, width, x, set);
}

}  // namespace

BandedMass::BandedMass(const fem::ParametricSystem& equations) : size_(equations.system.size()) {
  std::set<Index> touched;
  const auto visit = [](const fem::SparseMatrix& matrix, const auto& use) {
    for (int j = 0; j < matrix.outerSize(); ++j)
      for (fem::SparseMatrix::InnerIterator it(matrix, j); it; ++it)
        if (it.value() != 0.0) use(Index{it.row()}, Index{j}, it.value());
  };
  const auto widen = [&](Index i, Index j, double) {
    width_ = std::max(width_, static_cast<int>(std::abs(i - j)));
  };
  visit(equations.system.mass, widen);
  for (const auto& derivative : equations.derivatives) {
    visit(derivative.mass, widen);
    slopes_.emplace_back();
    visit(derivative.mass, [&](Index i, Index j, double value) {
      slopes_.back().push_back({i, j, value});
      touched.insert(i);
    });
  }
  support_.assign(touched.begin(), touched.end());
  if (!is_band()) {
    std::vector<const fem::SparseMatrix*> slopes;
    for (const auto& derivative : equations.derivatives) slopes.push_back(&derivative.mass);
    rows_ = ParametricRows(equations.system.mass, slopes);
    return;
  }
  reference_.assign(static_cast<std::size_t>(size_) * (2 * width_ + 1), 0.0);
  visit(equations.system.mass, [&](Index i, Index j, double value) { reference_[place(i, j)] = value; });
  band_ = reference_;
}

void BandedMass::set(const Eigen::VectorXd& change) {
  if (is_constant()) return;
  if (!is_band()) return rows_.set(change);
  for (const auto& slope : slopes_)
    for (const Entry& entry : slope)
      band_[place(entry.row, entry.column)] = reference_[place(entry.row, entry.column)];
  for (std::size_t j = 0; j < slopes_.size(); ++j)
    for (const Entry& entry : slopes_[j])
      band_[place(entry.row, entry.column)] += change[static_cast<Index>(j)] * entry.value;
}

void BandedMass::multiply(const double* x, double* y) const {
  if (!is_band()) return rows_.now().multiply(x, y);
  const auto set = [y](Index i, double sum) { y[i] = sum; };
  if (width_ == plain_width)
    multiply_band(band_.data(), size_, plain_width, x, set);
  else
    multiply_band(band_.data(), size_, width_, x, set);
}

void BandedMass::take_off(const Complex* x, Complex* y) const {
  if (!is_band()) return rows_.now().add_product(x, y, -1.0);
  const auto subtract = [y](Index i, const Complex& sum) { y[i] -= sum; };
  if (width_ == plain_width)
    multiply_band(band_.data(), size_, plain_width, x, subtract);
  else
    multiply_band(band_.data(), size_, width_, x, subtract);
}

void BandedMass::multiply(const Lanes* x, Lanes* y) const {
  if (is_band())
    multiply_lanes(band_.data(), size_, width_, x, y);
  else
    rows_.now().multiply(x, y);
}

namespace {

fem::SparseMatrix chosen_columns(const fem::SparseMatrix& matrix, const std::vector<Index>& columns) {
  fem::SparseMatrix chosen(matrix.rows(), static_cast<Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k] < 0 || columns[k] >= matrix.cols())
      throw std::invalid_argument("measured force is input " + std::to_string(columns[k]) +
                                  "; expected one of the system's " + std::to_string(matrix.cols()));
    chosen.col(static_cast<Index>(k)) = matrix.col(columns[k]);
  }
  return chosen;
}

std::vector<const fem::SparseMatrix*> slopes_of(const std::vector<fem::SparseMatrix>& matrices) {
  std::vector<const fem::SparseMatrix*> slopes;
  for (std::size_t j = 1; j < matrices.size(); ++j) slopes.push_back(&matrices[j]);
  return slopes;
}

// S from its parts, entry by entry.
BEAMID_WIDE_CLONE void sum_up(const double* stiffness, const double* mass, const double* dashpots,
                              std::size_t count, Complex by_stiffness, Complex by_mass, Complex by_dashpots,
                              Complex* sum) {
  for (std::size_t k = 0; k < count; ++k)
    sum[k] = stiffness[k] * by_stiffness + mass[k] * by_mass + dashpots[k] * by_dashpots;
}

}  // namespace

BandedEquations::Assembled::Assembled(const fem::ParametricSystem& equations)
    : stiffness{assembled_stiffness(equations.system.stiffness.strain, equations.system.stiffness.rigidity)},
      mass{equations.system.mass},
      dashpots{equations.system.damping} {
  for (const auto& derivative : equations.derivatives) {
    stiffness.push_back(assembled_stiffness(equations.strain, derivative.rigidity));
    mass.push_back(derivative.mass);
    dashpots.push_back(derivative.damping);
  }
}

SymmetricPattern BandedEquations::Assembled::pattern() const {
  std::vector<const fem::SparseMatrix*> all;
  for (const auto* const kind : {&stiffness, &mass, &dashpots})
    for (const fem::SparseMatrix& matrix : *kind) all.push_back(&matrix);
  return {mass.front().rows(), all};
}

BandedEquations::Entries::Entries(const SymmetricPattern& pattern,
                                  const std::vector<fem::SparseMatrix>& matrices)
    : reference(pattern.values(matrices.front())), now(reference) {
  for (const fem::SparseMatrix* slope : slopes_of(matrices)) {
    slopes.push_back(pattern.part(*slope));
    is_constant = is_constant && slopes.back().place.empty();
  }
}

void BandedEquations::Entries::set(const VectorXd& change) {
  if (is_constant) return;
  now = reference;
  for (std::size_t j = 0; j < slopes.size(); ++j) slopes[j].add(change[static_cast<Index>(j)], now);
}

BandedEquations::BandedEquations(const fem::ParametricSystem& equations, const MotionDescription& description)
    : BandedEquations(equations, description, Assembled(equations)) {}

BandedEquations::BandedEquations(const fem::ParametricSystem& equations, const MotionDescription& description,
                                 const Assembled& assembled)
    : description_(description),
      size_(equations.system.size()),
      stiffness_(equations),
      mass_(equations),
      pattern_(assembled.pattern()),
      stiffness_entries_(pattern_, assembled.stiffness),
      mass_entries_(pattern_, assembled.mass),
      dashpot_entries_(pattern_, assembled.dashpots),
      dashpots_(assembled.dashpots.front(), slopes_of(assembled.dashpots)),
      force_(chosen_columns(equations.system.inputs, description.forces)) {
  if (static_cast<Index>(equations.derivatives.size()) != description.properties())
    throw std::invalid_argument("the description drives " + std::to_string(description.properties()) +
                                " properties; expected the " + std::to_string(equations.derivatives.size()) +
                                " of the equations");
  for (const auto& derivative : equations.derivatives)
    force_slopes_.push_back(chosen_columns(derivative.inputs, description.forces));
  change_.setZero(properties());
}

bool BandedEquations::set(const PhysicalValues& values) {
  const bool properties_stay = is_set_ && values.change == change_;
  bool stays = properties_stay && values.mass_damping == mass_damping_ &&
               values.stiffness_damping == stiffness_damping_ && values.ratios == ratios_;
  if (stays) return false;
  is_set_ = true;
  mass_damping_ = values.mass_damping;
  stiffness_damping_ = values.stiffness_damping;
  ratios_ = values.ratios;
  mode_dampings_.clear();
  for (std::size_t i = 0; i < damped_modes().size(); ++i)
    mode_dampings_.push_back(damping_at(damped_modes()[i], values.change, ratios_[static_cast<Index>(i)]));
  if (properties_stay) return true;
  change_ = values.change;
  stiffness_.set(change_);
  mass_.set(change_);
  dashpots_.set(change_);
  for (Entries* entries : {&stiffness_entries_, &mass_entries_, &dashpot_entries_}) entries->set(change_);
  return true;
}

VectorXd BandedEquations::force(const VectorXd& input) const {
  VectorXd force = force_ * input.head(force_.cols());
  for (std::size_t j = 0; j < force_slopes_.size(); ++j)
    if (force_slopes_[j].nonZeros() > 0)
      force += change_[static_cast<Index>(j)] * (force_slopes_[j] * input.head(force_.cols()));
  return force;
}

VectorXd BandedEquations::force_slope(Index j, const VectorXd& input) const {
  return force_slopes_[j] * input.head(force_.cols());
}

double BandedEquations::highest_squared_frequency() const {
  double highest = 0.0;
  for (Index i = 0; i < size_; ++i) {
    const auto diagonal = static_cast<std::size_t>(pattern_.start(i + 1) - 1);
    highest = std::max(highest,
                       std::abs(stiffness_entries_.reference[diagonal]) / mass_entries_.reference[diagonal]);
  }
  return highest;
}

void BandedEquations::assemble(const Complex& lambda, std::vector<Complex>& entries) const {
  entries.resize(pattern_.entries());
  const Complex by_stiffness{1.0 + lambda.re * stiffness_damping_, lambda.im * stiffness_damping_};
  sum_up(stiffness_entries_.now.data(), mass_entries_.now.data(), dashpot_entries_.now.data(), entries.size(),
         by_stiffness, lambda * lambda + mass_damping_ * lambda, lambda, entries.data());
}

}  // namespace beamid::experiments::banded
