#include "experiments/models/banded/step_factor.hpp"

namespace beamid::experiments::banded {

StepFactor::StepFactor(const SymmetricPattern& pattern) : kind_(made_for(pattern)) {}

std::variant<StepFactor::Band, SparseFactor> StepFactor::made_for(const SymmetricPattern& pattern) {
  const int width = pattern.half_width();
  if (width > narrow_band) return SparseFactor(pattern);
  Band band{BandedFactor(pattern.size(), width), {}};
  const auto stride = static_cast<std::size_t>(band.factor.width()) + 1;
  for (Eigen::Index i = 0; i < pattern.size(); ++i)
    for (int k = pattern.start(i); k < pattern.start(i + 1); ++k)
      band.places.push_back(static_cast<std::size_t>(i) * stride + (stride - 1) -
                            static_cast<std::size_t>(i - pattern.column(k)));
  return band;
}

void StepFactor::factor(const std::vector<Complex>& entries) {
  if (auto* const sparse = std::get_if<SparseFactor>(&kind_)) return sparse->factor(entries);
  auto& [factor, places] = std::get<Band>(kind_);
  factor.fill(entries, places);
  factor.factor();
}

void StepFactor::solve(Complex* b) const {
  if (const auto* const sparse = std::get_if<SparseFactor>(&kind_)) return sparse->solve(b);
  std::get<Band>(kind_).factor.solve(b);
}

void StepFactor::solve(ComplexLanes* b) const {
  if (const auto* const sparse = std::get_if<SparseFactor>(&kind_)) return sparse->solve(b);
  std::get<Band>(kind_).factor.solve(b);
}

Eigen::VectorXd StepFactor::real_part_solved(const Eigen::VectorXd& b) const {
  std::vector<Complex> x(static_cast<std::size_t>(b.size()));
  for (Eigen::Index i = 0; i < b.size(); ++i) x[i] = {b[i], 0.0};
  solve(x.data());
  Eigen::VectorXd result(b.size());
  for (Eigen::Index i = 0; i < b.size(); ++i) result[i] = x[i].re;
  return result;
}

double StepFactor::growth(const std::vector<Complex>& entries) const {
  if (const auto* const sparse = std::get_if<SparseFactor>(&kind_)) return sparse->growth(entries);
  return std::get<Band>(kind_).factor.growth(entries);
}

}  // namespace beamid::experiments::banded
