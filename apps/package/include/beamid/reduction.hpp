// Fewer coordinates, and what authors of reductions need. Component reduction.
#pragma once

#include "reduction/constrained_statics.hpp"
#include "reduction/orthonormal_basis.hpp"
#include "reduction/reduction.hpp"
