// What the algorithms ask of a number, be it one double or several side by side (lanes.hpp).
//
// Branches on values become select(), so that every lane takes its own side of them; any() and all() are for
// what is rare enough to be asked of all lanes together.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace beamid::filters::algorithms {

template <class Scalar, int Rows, int Columns = Rows>
using Matrix = Eigen::Matrix<Scalar, Rows, Columns>;
template <class Scalar, int Rows>
using Vector = Eigen::Matrix<Scalar, Rows, 1>;

inline double select(bool condition, double yes, double no) {
  return condition ? yes : no;
}
inline bool any(bool condition) {
  return condition;
}
inline bool all(bool condition) {
  return condition;
}
inline double square_root(double x) {
  return std::sqrt(x);
}
inline double magnitude(double x) {
  return std::abs(x);
}
inline double larger(double a, double b) {
  return a < b ? b : a;
}

}  // namespace beamid::filters::algorithms
