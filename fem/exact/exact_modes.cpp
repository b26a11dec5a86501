#include "fem/exact/exact_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "fem/beam.hpp"
#include "fem/exact/uniform_piece.hpp"

namespace beamid::fem {
namespace {

// A chain of uniform pieces in harmonic motion: how many of its frequencies lie below a given one, and its
// modes.

/// What sits between two pieces: its dynamic stiffness is K - omega^2 M, and that of each absorber is added.
struct HarmonicNode {
  struct Absorber {
    double mass = 0.0, stiffness = 0.0;  ///< [kg], [N/m]
  };
  double position = 0.0;                                ///< [m]
  bool held[2] = {false, false};                        ///< deflection, rotation
  Eigen::Matrix2d mass = Eigen::Matrix2d::Zero();       ///< M of (w, theta) [kg, kg m, kg m2]
  Eigen::Matrix2d stiffness = Eigen::Matrix2d::Zero();  ///< K [N/m, N, N m]
  std::vector<Absorber> absorbers;

  bool is_clamped() const { return held[0] && held[1]; }
};

/// Nodes 0..n with n pieces between them, clamped at its ends only.
///
/// The states that the part left of x admits are a plane in the space of the four amplitudes; a basis Y (4 x
/// 2) of it, kept orthonormal, is carried from the first node to the last over steps so short that nothing
/// overflows or cancels. [wittrick1971]: eliminating the nodes one after another from the dynamic stiffness,
/// the number of negative pivots is the number of frequencies below omega, no step having one of its own with
/// its ends held. The pivot block of a node, referred to that basis, is U^T (F + T12^-1 T11 U): Y = [U; F], T
/// the step beyond the node.
class HarmonicChain {
 public:
  std::vector<HarmonicNode> nodes;
  std::vector<UniformPiece> pieces;

  /// Number of frequencies in (0, omega), and those of rigid-body and of unstable motions.
  int count_below(double omega) const;

  /// Deflection at sorted positions [m] of the mode at frequency omega, about 1 at its largest; where two
  /// modes share the frequency, `which` is 0 or 1. Zero when only an absorber moves, on a beam that it cannot
  /// reach.
  Eigen::VectorXd deflection(double omega, int which, const std::vector<double>& positions) const;

 private:
  struct Sweep;
  StateScale scale(double omega) const;
  Sweep sweep(double omega, bool keep) const;
};

using Eigen::Index, Eigen::Matrix2d, Eigen::Matrix4d, Eigen::Vector2d, Eigen::VectorXd;
using Basis = Eigen::Matrix<double, 4, 2>;

int negative_eigenvalues(const Matrix2d& q) {
  const double off = 0.5 * (q(0, 1) + q(1, 0)), determinant = q(0, 0) * q(1, 1) - off * off;
  if (determinant < 0.0) return 1;
  return q.trace() < 0.0 ? (determinant > 0.0 ? 2 : 1) : 0;
}

// Y = Q R; returns R^-1, which maps coefficients of Q to those of Y.
Matrix2d orthonormalise(Basis& y) {
  const double first = y.col(0).norm();
  y.col(0) /= first;
  const double along = y.col(0).dot(y.col(1));
  y.col(1) -= along * y.col(0);
  const double second = y.col(1).norm();
  y.col(1) /= second;
  return Matrix2d{{1.0 / first, -along / (first * second)}, {0.0, 1.0 / second}};
}

// Of the states, those with component i zero, and any reaction there. Returns the map of coefficients.
Matrix2d hold(Basis& y, int i) {
  const double size = y.row(i).norm();
  if (size == 0.0) return Matrix2d::Identity();  // already so, reaction included
  const Vector2d still = Vector2d(-y(i, 1), y(i, 0)) / size;
  y.col(0) = (y * still).eval();
  y(i, 0) = 0.0;
  y.col(1) = HarmonicState::Unit(2 + i);
  Matrix2d map = Matrix2d::Zero();
  map.col(0) = still;
  return map;
}

Matrix2d dynamic_stiffness(const HarmonicNode& node, double omega, const StateScale& scale) {
  Matrix2d z = node.stiffness - omega * omega * node.mass;
  for (const auto& [mass, stiffness] : node.absorbers) {
    const double inertia = omega * omega * mass, margin = stiffness - inertia;
    z(0, 0) -= inertia * stiffness / (margin != 0.0 ? margin : std::numeric_limits<double>::min());
  }
  for (int i = 0; i < 2; ++i)  // what a support holds does not load the beam
    if (node.held[i]) z.row(i).setZero(), z.col(i).setZero();
  const double unit = scale.bending_stiffness / scale.length;
  z(0, 0) /= unit / (scale.length * scale.length);
  z(0, 1) /= unit / scale.length;
  z(1, 0) /= unit / scale.length;
  z(1, 1) /= unit;
  return z;
}

struct HarmonicChain::Sweep {
  struct Step {
    double from = 0.0;                        // [m]
    Matrix4d rate = Matrix4d::Zero();         // A
    Basis basis = Basis::Zero();              // Y at its begin
    Matrix2d earlier = Matrix2d::Identity();  // from coefficients there to those of the step before
  };
  StateScale scale;
  int count = 0;
  std::vector<Step> steps;
  Matrix2d end = Matrix2d::Zero();     // what must vanish at the last node, per coefficient
  Matrix2d to_end = Matrix2d::Zero();  // from coefficients there to those of the last step
};

StateScale HarmonicChain::scale(double omega) const {
  double shortest = nodes.back().position - nodes.front().position, stiffness = 0.0;
  for (const UniformPiece& piece : pieces) {
    shortest = std::min(shortest, 1.0 / piece.wave_number(omega));
    stiffness = std::max(stiffness, piece.bending_stiffness);
  }
  return {shortest, stiffness};
}

HarmonicChain::Sweep HarmonicChain::sweep(double omega, bool keep) const {
  Sweep result;
  result.scale = scale(omega);
  Basis y = Basis::Identity();
  Matrix2d earlier = Matrix2d::Identity();
  const auto u = y.topRows<2>(), f = y.bottomRows<2>();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const HarmonicNode& node = nodes[i];
    y.bottomRows<2>() += dynamic_stiffness(node, omega, result.scale) * u;
    earlier *= orthonormalise(y);
    for (const auto& absorber : node.absorbers)
      if (omega * omega * absorber.mass > absorber.stiffness) ++result.count;
    if (i + 1 == nodes.size()) {
      for (int k = 0; k < 2; ++k) result.end.row(k) = y.row(node.held[k] ? k : 2 + k);
      result.to_end = earlier;
    }
    for (int k = 0; k < 2; ++k)
      if (node.held[k]) earlier *= hold(y, k);
    if (i + 1 == nodes.size()) break;

    const UniformPiece& piece = pieces[i];
    const double waves = piece.length * piece.wave_number(omega);
    constexpr double most_waves = 1e6;  // of a mode number that nobody asks for
    if (!(waves < most_waves))
      throw std::invalid_argument(
          "exact modes: the beam's length, stiffness, mass and springs lie too far apart for double "
          "precision; expected all of them in SI units");
    const int steps = std::max(1, static_cast<int>(std::ceil(waves)));
    const double step = piece.length / steps;
    const Matrix4d rate = piece.rate(omega, result.scale),
                   t = transition(rate * (step / result.scale.length));
    const Matrix2d near = t.topRightCorner<2, 2>().inverse() * t.topLeftCorner<2, 2>();
    for (int k = 0; k < steps; ++k) {
      result.count += negative_eigenvalues(u.transpose() * (f + near * u));
      if (keep) result.steps.push_back({node.position + k * step, rate, y, earlier});
      y = (t * y).eval();
      earlier = orthonormalise(y);
    }
  }
  result.count += negative_eigenvalues(u.transpose() * f);
  return result;
}

int HarmonicChain::count_below(double omega) const {
  return sweep(omega, false).count;
}

Eigen::VectorXd HarmonicChain::deflection(double omega, int which,
                                          const std::vector<double>& positions) const {
  const Sweep path = sweep(omega, true);
  const Eigen::JacobiSVD<Matrix2d> end(path.end, Eigen::ComputeFullV);
  Eigen::VectorXd w = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(positions.size()));
  if (end.singularValues()[1 - which] > 1e-6) return w;  // of order one where there is no mode
  Vector2d coefficients = path.to_end * end.matrixV().col(1 - which);
  std::vector<HarmonicState> begin(path.steps.size());
  double largest = 0.0;
  for (std::size_t k = path.steps.size(); k-- > 0;) {
    begin[k] = path.steps[k].basis * coefficients;
    coefficients = path.steps[k].earlier * coefficients;
    largest = std::max(largest, std::abs(begin[k][0]));
  }
  std::size_t k = 0;
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    while (k + 1 < begin.size() && path.steps[k + 1].from <= positions[i]) ++k;
    const double beyond = (positions[i] - path.steps[k].from) / path.scale.length;
    w[i] = advance(path.steps[k].rate * beyond, begin[k])[0] / largest;
  }
  return w;
}

// The beam as a researcher describes it, as chains for harmonic motion.

double added_mass(const Beam& beam, double place) {
  double sum = 0.0;
  for (const AddedMass& added : beam.added_masses)
    if (added.from < place && place < added.to) sum += added.mass_per_length;
  return sum;
}

/// A node at every break of the beam and a piece between neighbours; nothing where a piece is not uniform or
/// its compression is above two fifths of its shear stiffness.
/// @throws std::invalid_argument when the beam is impossible.
std::optional<HarmonicChain> chain_of(const Beam& beam) {
  const Mesh mesh = cut(beam, 1);
  HarmonicChain chain;
  for (const Mesh::Node& node : mesh.nodes) chain.nodes.push_back({.position = node.x, .absorbers = {}});
  for (const Mesh::Element& element : mesh.elements) {
    const Section& section = beam.segments[element.segment].section;
    if (!section.is_uniform()) return {};
    UniformPiece piece;
    piece.length = element.length;
    piece.bending_stiffness = element.remaining * section.bending_stiffness(0.0);
    piece.mass_per_length =
        section.mass_per_length(0.0) + added_mass(beam, mesh.nodes[element.first].x + 0.5 * element.length);
    piece.rotary_inertia = section.rotary_inertia(0.0);
    piece.shear_flexibility = section.shear_stiffness ? 1.0 / (*section.shear_stiffness)(0.0) : 0.0;
    piece.axial_load = beam.axial_load;
    if (piece.shear_flexibility * piece.axial_load > 0.4) return {};
    chain.pieces.push_back(piece);
  }
  const auto at = [&](double x) -> HarmonicNode& { return chain.nodes[mesh.node_at(x)]; };
  for (const Body& body : beam.bodies) {
    const double first = body.mass * body.eccentricity,
                 second = first * body.eccentricity + body.rotary_inertia;
    at(body.position).mass += Eigen::Matrix2d{{body.mass, first}, {first, second}};
  }
  for (const Spring& spring : beam.springs) {
    at(spring.position).stiffness(0, 0) += spring.translational;
    at(spring.position).stiffness(1, 1) += spring.rotational;
  }
  for (const Absorber& absorber : beam.absorbers)
    at(absorber.position).absorbers.push_back({absorber.mass, absorber.stiffness});
  for (const Support& support : beam.supports) {
    at(support.position).held[0] |= support.deflection;
    at(support.position).held[1] |= support.rotation;
  }
  return chain;
}

/// The parts that a clamp at an inner node separates; they move independently.
std::vector<HarmonicChain> split_where_clamped(const HarmonicChain& whole) {
  std::vector<HarmonicChain> parts(1);
  for (std::size_t i = 0; i < whole.nodes.size(); ++i) {
    parts.back().nodes.push_back(whole.nodes[i]);
    if (i + 1 == whole.nodes.size()) break;
    if (i > 0 && whole.nodes[i].is_clamped()) {
      parts.emplace_back().nodes.push_back(whole.nodes[i]);
      parts.back().nodes.back().absorbers.clear();
    }
    parts.back().pieces.push_back(whole.pieces[i]);
  }
  return parts;
}

/// Motions of a chain without strain (2 x 0, 1 or 2), each as (w at x = 0, slope): a translation, and a turn
/// about what holds the deflection or about the centre of mass.
Eigen::Matrix2Xd rigid_motions(const HarmonicChain& chain) {
  bool turning_held = chain.pieces.front().axial_load != 0.0, held = false;
  double pivot = 0.0, mass = 0.0, moment = 0.0;
  for (const HarmonicNode& node : chain.nodes) {
    turning_held |= node.held[1] || node.stiffness(1, 1) > 0.0;
    if (node.held[0] || node.stiffness(0, 0) > 0.0) {
      turning_held |= held;
      held = true;
      pivot = node.position;
    }
    mass += node.mass(0, 0);
    moment += node.mass(0, 0) * node.position + node.mass(0, 1);
    for (const auto& absorber : node.absorbers)
      mass += absorber.mass, moment += absorber.mass * node.position;
  }
  for (std::size_t i = 0; i < chain.pieces.size(); ++i) {
    const double part = chain.pieces[i].mass_per_length * chain.pieces[i].length;
    mass += part;
    moment += part * 0.5 * (chain.nodes[i].position + chain.nodes[i + 1].position);
  }
  if (!held) pivot = moment / mass;
  Eigen::Matrix2Xd motions(2, !held + !turning_held);
  if (!held) motions.col(0) << 1.0, 0.0;
  if (!turning_held) motions.rightCols(1) << -pivot, 1.0;
  return motions;
}

int count_below(const std::vector<HarmonicChain>& chains, double omega) {
  return std::accumulate(chains.begin(), chains.end(), 0,
                         [&](int sum, const HarmonicChain& chain) { return sum + chain.count_below(omega); });
}

// Of a frequency that two pivots decide between them; so near to one, rounding may make them disagree, and
// the count is one too many or too few.
constexpr double unsure = 1e-12;

// The smallest interval of numbers around root `wanted` (from 1): fewer roots lie below its begin. Every
// count is kept for the roots to come, and the last that is too low begins the search: a count next to an
// earlier root may be too high.
std::pair<double, double> bracket(const std::vector<HarmonicChain>& chains, int wanted,
                                  std::map<double, int>& counts) {
  while (counts.rbegin()->second < wanted) {
    const double next = 2.0 * counts.rbegin()->first;
    counts[next] = count_below(chains, next);
  }
  const auto above = std::find_if(counts.rbegin(), counts.rend(), [&](const auto& known) {
                       return known.second < wanted;
                     }).base();
  double low = std::prev(above)->first, high = above->first;
  while (high - low > std::numeric_limits<double>::epsilon() * high) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    const int count = counts[middle] = count_below(chains, middle);
    (count < wanted ? low : high) = middle;
  }
  return {low, high};
}

// Of the modes at a frequency the one that has `earlier` before it on the whole beam, at positions [m].
VectorXd shape(const std::vector<HarmonicChain>& chains, double frequency, int earlier,
               const VectorXd& positions) {
  VectorXd w = VectorXd::Zero(positions.size());
  const double low = (1.0 - unsure) * frequency, high = (1.0 + unsure) * frequency;
  int which = earlier - count_below(chains, low);
  for (const HarmonicChain& chain : chains) {
    const int here = chain.count_below(high) - chain.count_below(low);
    if (which >= here && &chain != &chains.back()) {
      which -= std::max(0, here);
      continue;
    }
    std::vector<Index> order;
    for (Index i = 0; i < positions.size(); ++i)
      if (positions[i] >= chain.nodes.front().position && positions[i] <= chain.nodes.back().position)
        order.push_back(i);
    std::sort(order.begin(), order.end(), [&](Index a, Index b) { return positions[a] < positions[b]; });
    std::vector<double> sorted;
    for (const Index i : order) sorted.push_back(positions[i]);
    const VectorXd part = chain.deflection(frequency, std::clamp(which, 0, 1), sorted);
    for (Index i = 0; i < part.size(); ++i) w[order[i]] = part[i];
    break;
  }
  return w;
}

void scale_to_one(Eigen::Ref<VectorXd> shape) {
  if (shape.size() == 0) return;
  Index largest = 0;
  if (shape.cwiseAbs().maxCoeff(&largest) > 1e-10)
    shape /= double{shape[largest]};
  else  // every position asked for is a node of the mode
    shape.setZero();
}

}  // namespace

std::optional<ExactModes> exact_modes(const Beam& beam, Index count, const VectorXd& positions) {
  if (count < 1)
    throw std::invalid_argument("count of modes is " + std::to_string(count) + "; expected at least 1");
  const auto whole = chain_of(beam);
  for (Index i = 0; i < positions.size(); ++i)
    if (!(positions[i] >= 0.0 && positions[i] <= beam.length())) {
      std::ostringstream message;
      message << "position is " << positions[i] << " m; expected between 0 and the beam's length, "
              << beam.length() << " m";
      throw std::invalid_argument(message.str());
    }
  if (!whole) return {};
  const std::vector<HarmonicChain> chains = split_where_clamped(*whole);
  const Eigen::Matrix2Xd rigid = chains.size() == 1 ? rigid_motions(chains[0]) : Eigen::Matrix2Xd(2, 0);
  const auto rigid_count = static_cast<int>(rigid.cols());
  const double length = beam.length(),
               start = std::sqrt(whole->pieces[0].bending_stiffness / whole->pieces[0].mass_per_length) /
                       (length * length);
  if (!(start > 0.0 && std::isfinite(start)))
    throw std::invalid_argument(
        "exact modes: the beam's length, stiffness and mass lie too far apart for double precision; expected "
        "all of them in SI units");
  if (beam.axial_load > 0.0 && count_below(chains, rigid_count > 0 ? 1e-7 * start : 0.0) > rigid_count)
    throw std::runtime_error("exact modes: the beam is unstable, its axial load is beyond buckling");

  ExactModes modes;
  modes.angular_frequency = VectorXd::Zero(count);
  modes.deflection = Eigen::MatrixXd::Zero(positions.size(), count);
  std::map<double, int> counts{{0.0, rigid_count}, {start, count_below(chains, start)}};
  for (Index j = 0; j < count; ++j) {
    if (j < rigid_count) {
      modes.deflection.col(j) = (rigid(0, j) + rigid(1, j) * positions.array()).matrix();
    } else {
      const auto [low, high] = bracket(chains, static_cast<int>(j) + 1, counts);
      modes.angular_frequency[j] = 0.5 * (low + high);
      modes.deflection.col(j) = shape(chains, modes.angular_frequency[j], static_cast<int>(j), positions);
    }
    scale_to_one(modes.deflection.col(j));
  }
  return modes;
}

}  // namespace beamid::fem
