// Fewer coordinates, and what authors of reductions need. Component reduction.
#pragma once

#include "reduction/method_options.hpp"
#include "reduction/orthonormal_basis.hpp"
#include "reduction/reduction.hpp"
#include "reduction/static_interpolation.hpp"
