// Numbers side by side: four columns of a block in one vector register.
#pragma once

namespace beamid::experiments::banded {

/// The same row of four columns. Compilers map the arithmetic on what the machine has; no operation mixes
/// lanes, so that the results do not depend on it.
struct alignas(32) Lanes {
  using Vector [[gnu::vector_size(32)]] = double;
  static constexpr int count = 4;

  Vector values{};

  Lanes& operator+=(const Lanes& other) {
    values += other.values;
    return *this;
  }
  Lanes& operator-=(const Lanes& other) {
    values -= other.values;
    return *this;
  }
  friend Lanes operator+(const Lanes& a, const Lanes& b) { return {a.values + b.values}; }
  friend Lanes operator-(const Lanes& a, const Lanes& b) { return {a.values - b.values}; }
  friend Lanes operator*(double factor, const Lanes& a) { return {factor * a.values}; }
  friend Lanes operator*(const Lanes& a, const Lanes& b) { return {a.values * b.values}; }
};

/// Complex numbers without the checks for infinities that std::complex multiplies with.
template <class Real>
struct ComplexOf {
  Real re{}, im{};

  ComplexOf& operator+=(const ComplexOf& other) {
    re += other.re;
    im += other.im;
    return *this;
  }
  ComplexOf& operator-=(const ComplexOf& other) {
    re -= other.re;
    im -= other.im;
    return *this;
  }
  friend ComplexOf operator+(const ComplexOf& a, const ComplexOf& b) { return {a.re + b.re, a.im + b.im}; }
  friend ComplexOf operator-(const ComplexOf& a, const ComplexOf& b) { return {a.re - b.re, a.im - b.im}; }
  friend ComplexOf operator*(double factor, const ComplexOf& z) { return {factor * z.re, factor * z.im}; }
};
using Complex = ComplexOf<double>;
using ComplexLanes = ComplexOf<Lanes>;

template <class Real>
inline ComplexOf<Real> operator*(const Complex& factor, const ComplexOf<Real>& z) {
  return {factor.re * z.re - factor.im * z.im, factor.re * z.im + factor.im * z.re};
}
inline Complex inverse(const Complex& z) {
  const double scale = 1.0 / (z.re * z.re + z.im * z.im);
  return {z.re * scale, -z.im * scale};
}

// A second copy of a function for processors with registers of four numbers, chosen when the program starts.
// Multiplication and addition stay apart (no FMA), as in the first, so that both give the same bits. The
// thread sanitizer cannot watch the choice, which is made before it has begun.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define BEAMID_WIDE_CLONE __attribute__((target_clones("avx2", "default")))
#else
#define BEAMID_WIDE_CLONE
#endif

}  // namespace beamid::experiments::banded
