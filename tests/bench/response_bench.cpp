// Response of a cantilever of 100 elements over 25,000 samples, beside plain loops over the same matrices as
// one would write them by hand with Eigen. Prints the best of several runs each, and how far both agree.
//
//     response_bench [elements] [samples]
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <limits>

#include "fem/assembly.hpp"
#include "fem/beam.hpp"
#include "fem/modes.hpp"
#include "fem/response/response.hpp"
#include "fem/stiffness_solver.hpp"

namespace {

using namespace beamid;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

double best_seconds(int runs, const std::function<void()>& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int run = 0; run < runs; ++run) {
    const std::clock_t start = std::clock();  // of the processor: other programs may be running
    work();
    best = std::min(best, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return best;
}

struct History {
  VectorXd displacement, velocity, acceleration;
};

// Average acceleration as in any textbook: assembled matrices, one factor, everything allocated before the
// loop.
History newmark_by_hand(const fem::StructuralSystem& system, const VectorXd& q0, const MatrixXd& inputs,
                        double h) {
  const fem::SparseMatrix k = system.stiffness.assembled(), &m = system.mass;
  const fem::SparseMatrix effective = m + 0.25 * h * h * k;
  const Eigen::SimplicialLDLT<fem::SparseMatrix> factor(effective), mass(m);
  const VectorXd seen = MatrixXd(system.outputs).row(0), load = MatrixXd(system.inputs).col(0);
  const Index samples = inputs.cols();
  History history{VectorXd(samples), VectorXd(samples), VectorXd(samples)};
  VectorXd d = q0, v = VectorXd::Zero(q0.size()), right = load * inputs(0, 0) - k * d, a = mass.solve(right);
  for (Index sample = 0; sample < samples; ++sample) {
    if (sample > 0) {
      d += h * v + (0.25 * h * h) * a;
      v += (0.5 * h) * a;
      right = load * inputs(0, sample);
      right.noalias() -= k * d;
      a = factor.solve(right);
      d += (0.25 * h * h) * a;
      v += (0.5 * h) * a;
    }
    history.displacement[sample] = seen.dot(d);
    history.velocity[sample] = seen.dot(v);
    history.acceleration[sample] = seen.dot(a);
  }
  return history;
}

// Mode by mode, the exact recurrence of an undamped or lightly damped oscillator under a force linear in
// between.
History modal_by_hand(const fem::StructuralSystem& system, const fem::Modes& modes, double xi,
                      const VectorXd& q0, const MatrixXd& inputs, double h) {
  const MatrixXd seen = system.outputs * modes.shape;
  const VectorXd start = modes.shape.transpose() * (system.mass * q0),
                 load = modes.shape.transpose() * system.inputs.col(0);
  const Index samples = inputs.cols();
  History history{VectorXd::Zero(samples), VectorXd::Zero(samples), VectorXd::Zero(samples)};
  for (Index i = 0; i < modes.size(); ++i) {
    const double w = modes.angular_frequency[i], wd = w * std::sqrt(1 - xi * xi), e = std::exp(-xi * w * h);
    const double c = e * std::cos(wd * h), s = e * std::sin(wd * h) / wd;
    const double a11 = c + xi * w * s, a12 = s, a21 = -w * w * s, a22 = c - xi * w * s;
    const double p = (1 - a11) / (w * w), r = (h - 2 * xi * w * p - s) / (w * w);  // step and ramp responses
    const double z0 = p - r / h, z1 = r / h, v0 = s - p / h, v1 = p / h;
    double z = start[i], v = 0.0;
    const double phi = seen(0, i), gamma = load[i];
    for (Index sample = 0; sample < samples; ++sample) {
      const double f = gamma * inputs(0, sample);
      history.displacement[sample] += phi * z;
      history.velocity[sample] += phi * v;
      history.acceleration[sample] += phi * (f - 2 * xi * w * v - w * w * z);
      if (sample + 1 == samples) break;
      const double g = gamma * inputs(0, sample + 1);
      const double next = a11 * z + a12 * v + z0 * f + z1 * g;
      v = a21 * z + a22 * v + v0 * f + v1 * g;
      z = next;
    }
  }
  return history;
}

double difference(const VectorXd& a, const VectorXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

void print(const char* what, double ours, double by_hand, double apart) {
  std::printf("%-44s %9.2f ms %9.2f ms %8.2f %10.1e\n", what, 1e3 * ours, 1e3 * by_hand, by_hand / ours,
              apart);
}

}  // namespace

int main(int argc, char** argv) {
  const int elements = argc > 1 ? std::atoi(argv[1]) : 100;
  const Index samples = argc > 2 ? std::atoi(argv[2]) : 25000;
  const double h = 1e-3, xi = 0.002;
  fem::Cantilever beam;
  beam.length = 1.10;
  beam.bending_stiffness = 2.12e11 * fem::rectangle_second_moment(0.060, 0.006);
  beam.mass_per_length = 3.055 / 1.10;
  beam.tip_mass = 0.36049;
  const fem::StructuralSystem system = fem::assemble(beam, elements);

  fem::Loading loading;
  loading.initial_displacement = 0.012 * fem::static_shape(system);
  fem::Loading forced = loading;
  forced.inputs = MatrixXd::Zero(2, samples);
  for (Index k = 0; k < samples; ++k) forced.inputs(0, k) = std::sin(25.0 * h * static_cast<double>(k));
  const MatrixXd none = MatrixXd::Zero(2, samples);
  const fem::TimeGrid grid{h, samples};

  std::printf("%d elements, %ld samples\n%-44s %12s %12s %8s %10s\n", elements, static_cast<long>(samples),
              "", "ours", "by hand", "ratio", "apart");
  const int runs = 11;
  fem::Response response;
  History history;
  for (const Index count : {Index{20}, std::min<Index>(system.size(), 200)}) {
    const fem::Modes modes = fem::modes(system, count);
    const double eigen = best_seconds(runs, [&] { fem::modes(system, count); });
    for (const bool is_forced : {false, true}) {
      const fem::Loading& used = is_forced ? forced : loading;
      const double ours = best_seconds(runs, [&] {
        response =
            respond(system, fem::ModalDamping{{xi}}, used, grid, {"modal", {{"modes", double(count)}}});
      });
      const double by_hand = best_seconds(runs, [&] {
        history = modal_by_hand(system, modes, xi, loading.initial_displacement,
                                is_forced ? forced.inputs : none, h);
      });
      char label[80];
      std::snprintf(label, sizeof label, "modal, %ld modes, %s", static_cast<long>(count),
                    is_forced ? "forced" : "release");
      print(label, ours - eigen, by_hand, difference(response.displacement.row(0), history.displacement));
    }
    std::printf("  (not counted on either side: %ld modes in %.2f ms)\n", static_cast<long>(count),
                1e3 * eigen);
  }
  for (const bool is_forced : {false, true}) {
    const fem::Loading& used = is_forced ? forced : loading;
    const double ours = best_seconds(runs, [&] {
      response = respond(system, fem::Undamped{}, used, grid, {"newmark", {}});
    });
    const double by_hand = best_seconds(runs, [&] {
      history = newmark_by_hand(system, loading.initial_displacement, is_forced ? forced.inputs : none, h);
    });
    print(is_forced ? "newmark, forced" : "newmark, release", ours, by_hand,
          difference(response.displacement.row(0), history.displacement));
  }
}
