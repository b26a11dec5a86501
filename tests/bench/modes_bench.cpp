// Lowest modes of a uniform beam, by beamid or by its peer Spectra + CHOLMOD on the assembled matrices.
//
//     modes_bench beamid clamped-free 500000 10
//     modes_bench cholmod clamped-free 500000 10
//
// prints seconds of assembly, seconds of the modes, relative error of the first frequency against the exact
// root, and the peak memory of the process [MB]. One solver per process, for the sake of the memory.
#include <Spectra/SymGEigsShiftSolver.h>
#include <sys/resource.h>

#include <Eigen/CholmodSupport>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <stdexcept>
#include <string>

#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "tests/bench/uniform_beam.hpp"

namespace beamid::bench {
namespace {

using Eigen::Index, Eigen::VectorXd;

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class InverseStiffness {
 public:
  using Scalar = double;
  explicit InverseStiffness(const fem::SparseMatrix& stiffness) : factors_(stiffness) {
    if (factors_.info() != Eigen::Success) throw std::runtime_error("CHOLMOD: factorisation failed");
  }
  Index rows() const { return factors_.rows(); }
  Index cols() const { return factors_.rows(); }
  void set_shift(double) {}
  void perform_op(const double* in, double* out) const {
    Eigen::Map<VectorXd>(out, rows()) = factors_.solve(Eigen::Map<const VectorXd>(in, rows()));
  }

 private:
  Eigen::CholmodSimplicialLDLT<fem::SparseMatrix> factors_;
};

class Mass {
 public:
  using Scalar = double;
  explicit Mass(const fem::SparseMatrix& mass) : mass_(mass) {}
  Index rows() const { return mass_.rows(); }
  Index cols() const { return mass_.rows(); }
  void perform_op(const double* in, double* out) const {
    Eigen::Map<VectorXd>(out, rows()).noalias() = mass_ * Eigen::Map<const VectorXd>(in, rows());
  }

 private:
  const fem::SparseMatrix& mass_;
};

// The tolerance of fem/solvers/rigid_complement.cpp, and the subspace that takes Spectra the least time.
VectorXd peer(const fem::SparseMatrix& stiffness, const fem::SparseMatrix& mass, Index count) {
  InverseStiffness inverse(stiffness);
  Mass product(mass);
  Spectra::SymGEigsShiftSolver<InverseStiffness, Mass, Spectra::GEigsMode::ShiftInvert> lanczos(
      inverse, product, count, std::max<Index>(2 * count + 4, 12), 0.0);
  lanczos.init();
  lanczos.compute(Spectra::SortRule::LargestMagn, 100, 1e-10, Spectra::SortRule::SmallestAlge);
  const Eigen::MatrixXd shapes = lanczos.eigenvectors();
  if (lanczos.info() != Spectra::CompInfo::Successful)
    std::fprintf(stderr, "cholmod: only %ld of %ld eigenvalues converged\n", static_cast<long>(shapes.cols()),
                 static_cast<long>(count));
  return lanczos.eigenvalues();
}

int run(const std::string& solver, const std::string& supports, int elements, Index count) {
  const UniformBeam uniform = uniform_beam(supports);
  const double start = seconds();
  auto system = fem::assemble(uniform.beam, elements, {});
  double assembled = seconds(), square = 0.0;
  std::clock_t ticks = std::clock();
  if (solver == "beamid") {
    const fem::Modes modes = fem::modes(system, count);
    square = std::pow(modes.angular_frequency[modes.rigid], 2);
  } else if (solver == "cholmod") {
    const fem::SparseMatrix stiffness = system.stiffness.assembled(), mass = system.mass;
    system = {};
    assembled = seconds();
    ticks = std::clock();
    const VectorXd squares = peer(stiffness, mass, count);
    square = squares.size() > 0 ? squares.cwiseAbs().minCoeff() : std::nan("");
  } else {
    throw std::invalid_argument("unknown solver '" + solver + "'; known: beamid, cholmod");
  }
  const double done = seconds(), processor = static_cast<double>(std::clock() - ticks) / CLOCKS_PER_SEC;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("%s %s %d %.4f %.4f %.4f %.2e %.0f\n", solver.c_str(), supports.c_str(), elements,
              assembled - start, done - assembled, processor,
              std::abs(std::sqrt(std::abs(square)) / (uniform.root * uniform.root) - 1.0),
              static_cast<double>(usage.ru_maxrss) / 1024.0);
  return 0;
}

}  // namespace
}  // namespace beamid::bench

int main(int argc, char** argv) try {
  if (argc != 5) {
    std::fprintf(stderr, "usage: modes_bench beamid|cholmod SUPPORTS ELEMENTS MODES\n");
    return 2;
  }
  return beamid::bench::run(argv[1], argv[2], std::stoi(argv[3]), std::stol(argv[4]));
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
