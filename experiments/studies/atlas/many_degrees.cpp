#include "experiments/studies/atlas/many_degrees.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "experiments/studies/paper/monte_carlo.hpp"
#include "experiments/studies/paper/numerical_validation.hpp"
#include "experiments/text/progress.hpp"
#include "fem/modes.hpp"
#include "fem/parametric_system.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::SecondOrder;

constexpr double not_found = std::numeric_limits<double>::quiet_NaN();
constexpr double ratio_of_damping = 0.01, displaced = 0.01;  // [-], [m]

struct UndampedModes {
  VectorXd frequency;  // w (n)
  MatrixXd shape;      // phi, phi^T M phi = 1 (n x n)
};

UndampedModes undamped_modes(const SecondOrder& of) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(of.stiffness, of.mass);
  return {solver.eigenvalues().cwiseSqrt(), solver.eigenvectors()};
}

// The spring below a floor.
MatrixXd spring(Index floors, Index floor) {
  MatrixXd matrix = MatrixXd::Zero(floors, floors);
  matrix(floor, floor) = 1.0;
  if (floor == 0) return matrix;
  matrix(floor - 1, floor - 1) = 1.0;
  matrix(floor - 1, floor) = matrix(floor, floor - 1) = -1.0;
  return matrix;
}

/// Adds unknowns to a family, with how far a filter may have to go: a tenth of a stiffness, and of a damping
/// itself or dt K, whichever is larger.
class PartList {
 public:
  PartList(UnknownFamily& family, double damping_time) : family_(family), time_(damping_time) {}

  void stiffness(std::string name, std::string unit, double value, MatrixXd matrix, double size) {
    constexpr double share = 0.1;
    family_.parts.push_back(
        {std::move(name), std::move(unit), false, value, share * size, size, std::move(matrix)});
  }
  /// @param of_k the same number of K, in the unit of the damping times 1/s
  void damping(std::string name, std::string unit, double value, MatrixXd matrix, double size, double of_k) {
    family_.parts.push_back(
        {std::move(name), std::move(unit), true, value, time_ * of_k, size, std::move(matrix)});
  }

 private:
  UnknownFamily& family_;
  double time_;
};

std::string numbered(const char* name, Index j) {
  return name + std::to_string(j + 1);
}

// Masses and springs of the chain of three are those of docs/theory/many_degrees_of_freedom.md.
void describe_chain(int storeys, VectorXd& masses, VectorXd& stiffnesses) {
  masses = VectorXd::Constant(storeys, 1000.0);
  stiffnesses = VectorXd::LinSpaced(storeys, 2.0e6, 1.0e6);
  if (storeys != 3) return;
  masses << 1000.0, 800.0, 900.0;
  stiffnesses << 2.0e6, 1.5e6, 1.2e6;
}

/// Coordinates are those of the first modes: M = I, K diagonal, a damping ratio for each.
UnknownFamily modal_family(const std::string& name, const std::string& unknowns,
                           const fem::ParametricSystem& parametric, const std::vector<std::string>& names,
                           const std::vector<std::string>& units, Index count) {
  const fem::Modes modes = fem::modes(parametric.system, count);
  const VectorXd& w = modes.angular_frequency;
  constexpr double highest_step = 0.2, periods = 6.0;
  UnknownFamily family;
  family.structure = name;
  family.unknowns = unknowns;
  family.interval = highest_step / w[count - 1];
  family.samples = static_cast<Index>(periods * 2.0 * M_PI / (w[0] * family.interval));
  family.truth = {MatrixXd::Identity(count, count), MatrixXd((2.0 * ratio_of_damping * w).asDiagonal()),
                  MatrixXd(w.cwiseAbs2().asDiagonal())};
  family.outputs = parametric.system.outputs * modes.shape;
  family.start = displaced * family.outputs.cwiseAbs().colwise().maxCoeff().cwiseInverse().transpose();
  PartList parts(family, std::max(2.0 * ratio_of_damping / w[0], family.interval));
  family.fixed_stiffness = family.truth.stiffness;
  for (std::size_t j = 0; j < names.size(); ++j) {
    const double value = parametric.values[static_cast<Index>(j)];
    const MatrixXd slope = modes.shape.transpose() * (parametric.stiffness_derivative(j) * modes.shape);
    family.fixed_stiffness -= value * slope;
    parts.stiffness(names[j], units[j], value, slope, value);
  }
  for (Index k = 0; k < count; ++k) {
    MatrixXd matrix = MatrixXd::Zero(count, count);
    matrix(k, k) = 2.0 * w[k];
    parts.damping(numbered("ratio_", k), "1", ratio_of_damping, std::move(matrix), ratio_of_damping, w[k]);
  }
  return family;
}

SecondOrder changed_by(const SecondOrder& truth, const MatrixXd& damping, const MatrixXd& stiffness) {
  return {truth.mass, truth.damping + damping, truth.stiffness + stiffness};
}

}  // namespace

UnknownFamily chain_family(int storeys, double dt, const std::string& unknowns) {
  VectorXd masses, stiffnesses;
  describe_chain(storeys, masses, stiffnesses);
  const Index n = storeys;
  MatrixXd stiffness = MatrixXd::Zero(n, n);
  for (Index j = 0; j < n; ++j) stiffness += stiffnesses[j] * spring(n, j);
  UnknownFamily family;
  family.structure = fmt::format("chain {}", storeys);
  family.unknowns = unknowns;
  family.interval = dt;
  family.truth = {masses.asDiagonal(), stiffness, stiffness};
  const UndampedModes modes = undamped_modes(family.truth);
  const MatrixXd momentum = family.truth.mass * modes.shape;
  const MatrixXd of_one_ratio = momentum * (2.0 * modes.frequency).asDiagonal() * momentum.transpose();
  const double beta = 2.0 * ratio_of_damping / modes.frequency[0];
  family.truth.damping = beta * stiffness;
  if (unknowns == "one ratio") family.truth.damping = ratio_of_damping * of_one_ratio;
  family.outputs = MatrixXd::Identity(n, n);
  family.start =
      displaced * modes.shape * modes.shape.cwiseAbs().colwise().maxCoeff().cwiseInverse().transpose();
  const double periods = storeys > 6 ? 1.0 : 3.0;
  family.complete = unknowns == "all entries" || unknowns == "modes";
  family.samples = static_cast<Index>(
      family.complete ? 500.0 : std::max(500.0, periods * 2.0 * M_PI / (modes.frequency[0] * dt)));
  PartList parts(family, std::max(beta, dt));

  if (unknowns == "all entries") {
    const auto entry = [&](const MatrixXd& of, Index i, Index j) {
      return std::pair{of(i, j), std::sqrt(of(i, i) * of(j, j))};
    };
    for (const bool damping : {false, true})
      for (Index i = 0; i < n; ++i)
        for (Index j = i; j < n; ++j) {
          MatrixXd matrix = MatrixXd::Zero(n, n);
          matrix(i, j) = matrix(j, i) = 1.0;
          const auto [k, size_of_k] = entry(stiffness, i, j);
          const auto [c, size_of_c] = entry(family.truth.damping, i, j);
          const std::string place = fmt::format("{}{}", i + 1, j + 1);
          if (damping)
            parts.damping("C_" + place, "N s/m", c, std::move(matrix), size_of_c, size_of_k);
          else
            parts.stiffness("K_" + place, "N/m", k, std::move(matrix), size_of_k);
        }
    return family;
  }
  if (unknowns == "modes") {
    for (const bool damping : {false, true})
      for (Index j = 0; j < n; ++j) {
        const double square = modes.frequency[j] * modes.frequency[j];
        MatrixXd matrix = momentum.col(j) * momentum.col(j).transpose();
        if (damping)
          parts.damping(numbered("two_xi_omega_", j), "1/s", beta * square, std::move(matrix), beta * square,
                        square);
        else
          parts.stiffness(numbered("omega_squared_", j), "1/s2", square, std::move(matrix), square);
      }
    return family;
  }
  for (Index j = 0; j < n; ++j)
    parts.stiffness(numbered("k_", j), "N/m", stiffnesses[j], spring(n, j), stiffnesses[j]);
  if (unknowns == "storeys") {
    for (Index j = 0; j < n; ++j)
      parts.damping(numbered("c_", j), "N s/m", beta * stiffnesses[j], spring(n, j), beta * stiffnesses[j],
                    stiffnesses[j]);
  } else if (unknowns == "Rayleigh") {
    const double square = modes.frequency[0] * modes.frequency[0];
    parts.damping("alpha", "1/s", 0.0, family.truth.mass, beta * square, square);
    parts.damping("beta", "s", beta, stiffness, beta, 1.0);
  } else if (unknowns == "one ratio") {
    parts.damping("ratio", "1", ratio_of_damping, of_one_ratio, ratio_of_damping, modes.frequency[n - 1]);
  } else {
    throw std::invalid_argument("no unknowns '" + unknowns + "' of a chain");
  }
  return family;
}

UnknownFamily frame_family() {
  fem::Frame frame;
  constexpr double width = 5.0, height = 3.2, modulus = 2.1e11, density = 7850.0;
  const char* const names[] = {"foot_a", "foot_b", "a1", "m1", "b1", "a2", "m2", "b2"};
  const double x[] = {0.0, 1.0, 0.0, 0.5, 1.0, 0.0, 0.5, 1.0}, y[] = {0, 0, 1, 1, 1, 2, 2, 2};
  for (std::size_t j = 0; j < std::size(names); ++j)
    frame.joints.push_back({width * x[j], height * y[j], names[j]});
  const auto member = [&](int first, int second, double depth, const char* group) {
    constexpr double breadth = 0.1;
    fem::Frame::Member made;
    made.first = first;
    made.second = second;
    made.section.bending_stiffness = modulus * fem::rectangle_second_moment(breadth, depth);
    made.section.mass_per_length = density * breadth * depth;
    made.section.axial_stiffness = modulus * breadth * depth;
    made.group = group;
    frame.members.push_back(made);
  };
  for (const auto& [first, second] : {std::pair{0, 2}, {1, 4}, {2, 5}, {4, 7}})
    member(first, second, 0.1, "columns");
  for (const auto& [first, second] : {std::pair{2, 3}, {3, 4}, {5, 6}, {6, 7}})
    member(first, second, 0.12, "girders");
  frame.supports = {{0}, {1}};
  for (const int joint : {2, 4}) frame.bodies.push_back({joint, 1500.0});
  for (const int joint : {5, 7}) frame.bodies.push_back({joint, 1200.0});
  std::vector<fem::Point> points;
  for (const char* place : {"a1.x", "a2.x", "m1.y", "m2.y"}) points.push_back({place, 0.0, place});
  using Quantity = fem::BeamParameter::Quantity;
  const fem::ParametricSystem parametric = fem::assemble_parametric(
      frame, 4, points, {{Quantity::factor, {}, "columns"}, {Quantity::factor, {}, "girders"}});
  return modal_family("frame", "groups, ratios", parametric, {"columns", "girders"}, {"1", "1"}, 4);
}

UnknownFamily beam_family() {
  const fem::Beam beam = paper::steel_beam(paper::test_beams[1]);
  const fem::ParametricSystem parametric =
      fem::assemble_parametric(beam, 22, {{"a", 0.4}, {"b", 0.75}, {"tip", 1.1}},
                               {{fem::BeamParameter::Quantity::bending_stiffness, {}}});
  return modal_family("beam", "E I, ratios", parametric, {"bending_stiffness"}, {"N m2"}, 3);
}

double DegreesCase::apart(bool damping) const {
  double difference = 0.0, bias = 0.0;
  for (std::size_t j = 0; j < points.size(); ++j) {
    const UnknownFamily::Part& part = family.parts[j];
    if (part.damping != damping) continue;
    difference = std::max(difference, std::abs(points[j].found - points[j].law) / part.scale);
    bias = std::max(bias, std::abs(points[j].law - part.value) / part.scale);
  }
  return difference / bias;
}

double DegreesCase::apart_of_dt_k() const {
  double difference = 0.0, whole = 0.0;
  for (std::size_t j = 0; j < points.size(); ++j) {
    if (!family.parts[j].damping) continue;
    difference = std::max(difference, std::abs(points[j].found - points[j].law) / family.parts[j].scale);
    whole = std::max(whole, std::abs(points[j].by_dt_k) / family.parts[j].scale);
  }
  return difference / whole;
}

DegreesCase degrees_case(const UnknownFamily& family, const std::string& scheme) {
  const auto method = filters::scheme_registry().make(scheme, {});
  const SecondOrder& truth = family.truth;
  const filters::BiasTerms terms = filters::first_terms(*method, truth, family.interval);
  const MatrixXd near =
      nearest(family, {filters::seen_through(*method, truth, family.interval),
                       changed_by(truth, terms.damping, terms.stiffness),
                       changed_by(truth, family.interval * truth.stiffness, 0.0 * truth.stiffness)});
  const VectorXd law = near.col(0), first = near.col(1), shifted = near.col(2);
  const std::optional<VectorXd> found = measured_unknowns(family, scheme);
  const auto shifted_by = [&](Index j) {
    constexpr double rounding = 1e-9;
    const UnknownFamily::Part& part = family.parts[static_cast<std::size_t>(j)];
    const double shift = shifted[j] - part.value;
    return std::abs(shift) > rounding * part.scale ? shift : 0.0;
  };
  DegreesCase made{family, scheme, {}};
  for (Index j = 0; j < law.size(); ++j)
    made.points.push_back({law[j], first[j], found ? (*found)[j] : not_found, shifted_by(j)});
  return made;
}

namespace {

DegreesCure cure_of(int storeys, double dt) {
  const UnknownFamily family = chain_family(storeys, dt, "modes");
  const UndampedModes modes = undamped_modes(family.truth);
  const auto worst = [&](const MatrixXd& damping) {
    const MatrixXd off = modes.shape.transpose() * (damping - family.truth.damping) * modes.shape,
                   own = modes.shape.transpose() * family.truth.damping * modes.shape;
    const Eigen::ArrayXd errors = off.diagonal().array() / own.diagonal().array();
    Index at = 0;
    errors.abs().maxCoeff(&at);
    return 100.0 * errors[at];
  };
  DegreesCure cure{family.structure, dt,        modes.frequency[storeys - 1] * dt,
                   not_found,        not_found, not_found,
                   not_found,        not_found};
  const MatrixXd& c = family.truth.damping;
  cure.predicted = worst(c - 0.5 * dt * c * family.truth.mass.inverse() * c);
  if (const auto values = measured_unknowns(family, "forward_euler")) {
    const SecondOrder found = family.at(*values);
    const auto euler = filters::scheme_registry().make("forward_euler", {});
    cure.found = worst(found.damping);
    cure.subtracted = worst(found.damping - dt * found.stiffness);
    cure.behind = worst(filters::behind(*euler, found, dt).damping);
  }
  constexpr int most = 3;  // the exact scheme without structure takes an exponential for each unknown
  if (storeys <= most)
    if (const auto values = measured_unknowns(family, "exponential"))
      cure.exact = worst(family.at(*values).damping);
  return cure;
}

constexpr double relative_noise = 1e-3;
constexpr int noise_seeds = 20;

// Of every dashpot of the chain of three, by one filter and scheme over the seeds.
std::vector<DegreesNoise> noisy_case(const std::string& filter, const std::string& scheme) {
  const UnknownFamily family = chain_family(3, 0.002, "storeys");
  const SecondOrder& truth = family.truth;
  const MatrixXd near = nearest(
      family, {filters::seen_through(*filters::scheme_registry().make(scheme, {}), truth, family.interval),
               changed_by(truth, family.interval * truth.stiffness, 0.0 * truth.stiffness)});
  const VectorXd values = family.values(), bound = bounds(family, relative_noise);
  MatrixXd errors(values.size(), noise_seeds);
  for (int seed = 0; seed < noise_seeds; ++seed) {
    const auto found =
        measured_unknowns(family, scheme, {filter, relative_noise, static_cast<std::uint64_t>(seed + 1)});
    errors.col(seed) = found ? VectorXd(*found - values) : VectorXd::Constant(values.size(), not_found);
  }
  std::vector<DegreesNoise> made;
  for (Index j = 0; j < values.size(); ++j) {
    const UnknownFamily::Part& part = family.parts[static_cast<std::size_t>(j)];
    if (!part.damping) continue;
    const double mean = errors.row(j).mean(), by_dt_k = near(j, 1) - values[j],
                 scatter = std::sqrt((errors.row(j).array() - mean).square().sum() / (noise_seeds - 1));
    made.push_back({family.unknowns, filter, scheme, part.name, mean / by_dt_k,
                    (near(j, 0) - values[j]) / by_dt_k, mean / bound[j], scatter / bound[j]});
  }
  return made;
}

}  // namespace

DegreesPage make_degrees_page(const Progress& progress) {
  constexpr double dt = 0.002;
  std::vector<UnknownFamily> families{chain_family(3, dt, "all entries")};
  families.push_back(chain_family(3, dt, "storeys"));
  for (const int storeys : {6, 12})
    for (const char* unknowns : {"modes", "storeys"}) families.push_back(chain_family(storeys, dt, unknowns));
  families.push_back(frame_family());
  families.push_back(beam_family());
  DegreesPage page;
  Countdown countdown(progress, families.size(), "families");
  for (const UnknownFamily& family : families) {
    countdown.begin(family.structure);
    for (const std::string& scheme : paper::compared_schemes())
      if (scheme != "exponential") page.cases.push_back(degrees_case(family, scheme));
    countdown.count();
  }
  for (const char* unknowns : {"storeys", "Rayleigh", "one ratio"})
    for (const double interval : {1e-4, 5e-4, 2e-3})
      page.projections.push_back(degrees_case(chain_family(3, interval, unknowns), "forward_euler"));
  for (const int storeys : {3, 6, 12})
    for (const double interval : {1e-3, 2e-3, 5e-3}) page.cures.push_back(cure_of(storeys, interval));
  for (const char* filter : {"ekf", "ukf"})
    for (const char* scheme : {"forward_euler", "exponential"})
      for (DegreesNoise& one : noisy_case(filter, scheme)) page.noisy.push_back(std::move(one));
  return page;
}

}  // namespace beamid::experiments
