// What compiled_eigen.hpp declares.
#define BEAMID_COMPILED_EIGEN template
#include "fem/libraries/compiled_eigen.hpp"
