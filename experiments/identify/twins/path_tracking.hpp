// One solution followed from the easy system to the wanted one.
#pragma once

#include <optional>

#include "experiments/identify/twins/minor_system.hpp"

namespace beamid::experiments {

/// A solution that exists for sure, and no second one near it.
struct CertifiedSolution {
  ComplexVector u;      ///< ln k, approximately
  double radius = 0.0;  ///< the solution lies within it, in every component; no other one within 2 of them
};

/// tau = s / (s + (1 - s) gamma), s from 0 to 1: an arc that, for all gamma but finitely many, meets no
/// system with a multiple solution. Runge-Kutta's fourth order predicts, Newton's method corrects, and a step
/// that needs more than a small correction is halved.
/// @return nothing when steps become too short: solutions meet.
std::optional<ComplexVector> follow_path(const MinorSystem& system, ComplexVector u, PathComplex gamma,
                                         double largest_correction);

/// Newton's method at tau = 1 and Kantorovich's theorem: with beta = |J^-1 F| and L a bound of
/// |J^-1| |F''| nearby, beta L <= 1/4 proves a solution within 2 beta. beta includes the rounding of F.
std::optional<CertifiedSolution> certified(const MinorSystem& system, ComplexVector u);

}  // namespace beamid::experiments
