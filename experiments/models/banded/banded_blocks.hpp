// Four directions at a time: from the columns of a matrix into lanes, and back.
#pragma once

#include <Eigen/Core>

#include "experiments/models/banded/banded_lanes.hpp"

namespace beamid::experiments::banded {

/// Row i of four columns (n each) into block[i].
void gather(const double* const* columns, Eigen::Index size, Lanes* block);

/// K q - lambda M q' (n) from K q and M q', lambda = (3 + i sqrt 3) / dt.
void right_side(const Lanes* stiff, const Lanes* momentum, double interval, Eigen::Index size,
                ComplexLanes* right);

/// right += forcing times each direction's part of it, in the rows [first, last).
void add_forcing(const Complex* forcing, const Lanes& part, Eigen::Index first, Eigen::Index last,
                 ComplexLanes* right);

/// right += sum_i factor_i g_i, of `count` vectors g_i (n) with a factor of each direction.
void add_multiples(const double* const* g, const ComplexLanes* factors, int count, Eigen::Index size,
                   ComplexLanes* right);

/// What the solution d (n) adds to q and q', into four columns each: 4 sqrt3 Im d and
/// (12 / dt) (Re d + sqrt3 Im d).
void scatter(const ComplexLanes* change, double interval, Eigen::Index size, double* const* columns,
             double* const* rates);

}  // namespace beamid::experiments::banded
