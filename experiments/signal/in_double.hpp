// Inverse distributions worked out in double.
#pragma once

#include <boost/math/policies/policy.hpp>

namespace beamid::experiments {

/// Not by way of long double: the tables of its inverse error function are made when a program starts, and
/// overflow where a processor (valgrind's) has but 64 bits of it.
using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

}  // namespace beamid::experiments
