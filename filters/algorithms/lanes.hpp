// Several doubles side by side, as one scalar of the algorithms.
#pragma once

#include <Eigen/Core>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace beamid::filters::algorithms {

/// Code for the processors that the whole library is compiled for.
struct Baseline {};

/// A vector of the compiler's own; a type by itself because the attribute may only depend on it from outside.
template <class Number, int W>
struct VectorOf {
  // NOLINTNEXTLINE(modernize-use-using): compilers take the attribute on a typedef only
  typedef Number Type __attribute__((vector_size(W * sizeof(Number))));
};

// Two things for which the compiler's vectors have no operator. They bear the name of the processor, as
// below.
#if defined(__SSE2__) && !defined(__clang__)
#define BEAMID_SSE2_BUILTINS 1
#endif

/// Whether any lane has a bit set; a condition sets all or none.
template <class Instructions, int W, class Bits>
[[gnu::always_inline]] inline bool any_of(const Bits& bits) {
#ifdef BEAMID_SSE2_BUILTINS
  if constexpr (W == 2)
    return __builtin_ia32_movmskpd(std::bit_cast<typename VectorOf<double, 2>::Type>(bits)) != 0;
#endif
  std::int64_t some = 0;
  for (int i = 0; i < W; ++i) some |= bits[i];
  return some != 0;
}

/// Square root of each lane.
template <class Instructions, int W, class Values>
[[gnu::always_inline]] inline Values roots_of(const Values& values) {
#ifdef BEAMID_SSE2_BUILTINS
  if constexpr (W == 2) return __builtin_ia32_sqrtpd(values);
#endif
#if defined(BEAMID_SSE2_BUILTINS) && defined(__AVX__)
  if constexpr (W == 4) return __builtin_ia32_sqrtpd256(values);
#endif
  Values roots{};
  for (int i = 0; i < W; ++i) roots[i] = std::sqrt(values[i]);
  return roots;
}

/// W doubles that move together; a power of two. `Instructions` names the processor that the code is compiled
/// for: code of one and the same template compiled for two processors must not bear the same name.
template <int W, class Instructions>
struct Lanes {
  using Values = typename VectorOf<double, W>::Type;
  using Bits = typename VectorOf<std::int64_t, W>::Type;

  /// A condition per lane.
  struct Mask {
    Bits bits;
    friend Mask operator&(Mask a, Mask b) { return {a.bits & b.bits}; }
    friend Mask operator|(Mask a, Mask b) { return {a.bits | b.bits}; }
    friend Mask operator!(Mask a) { return {~a.bits}; }
    bool operator[](int lane) const { return bits[lane] != 0; }
    friend bool any(Mask mask) { return any_of<Instructions, W>(mask.bits); }
    friend bool all(Mask mask) { return !any(!mask); }
  };

  Values values;

  Lanes() = default;
  Lanes(double all_lanes) : values(Values{} + all_lanes) {}  // NOLINT: a number is a number in each lane
  Lanes(Values given) : values(given) {}
  double operator[](int lane) const { return values[lane]; }

  friend Lanes operator+(const Lanes& a, const Lanes& b) { return a.values + b.values; }
  friend Lanes operator-(const Lanes& a, const Lanes& b) { return a.values - b.values; }
  friend Lanes operator*(const Lanes& a, const Lanes& b) { return a.values * b.values; }
  friend Lanes operator/(const Lanes& a, const Lanes& b) { return a.values / b.values; }
  Lanes operator-() const { return -values; }
  Lanes& operator+=(const Lanes& b) { return values += b.values, *this; }
  Lanes& operator-=(const Lanes& b) { return values -= b.values, *this; }
  Lanes& operator*=(const Lanes& b) { return values *= b.values, *this; }
  Lanes& operator/=(const Lanes& b) { return values /= b.values, *this; }
  friend Mask operator<(const Lanes& a, const Lanes& b) { return {a.values < b.values}; }
  friend Mask operator>(const Lanes& a, const Lanes& b) { return {a.values > b.values}; }
  friend Mask operator<=(const Lanes& a, const Lanes& b) { return {a.values <= b.values}; }
  friend Mask operator>=(const Lanes& a, const Lanes& b) { return {a.values >= b.values}; }
  friend Mask operator==(const Lanes& a, const Lanes& b) { return {a.values == b.values}; }

  friend Lanes select(Mask mask, const Lanes& yes, const Lanes& no) {
    return mask.bits ? yes.values : no.values;
  }
  friend Lanes magnitude(const Lanes& x) {
    return std::bit_cast<Values>(std::bit_cast<Bits>(x.values) & std::numeric_limits<std::int64_t>::max());
  }
  friend Lanes larger(const Lanes& a, const Lanes& b) { return a.values < b.values ? b.values : a.values; }
  friend Lanes square_root(const Lanes& x) { return roots_of<Instructions, W>(x.values); }
};

}  // namespace beamid::filters::algorithms

template <int W, class Instructions>
struct Eigen::NumTraits<beamid::filters::algorithms::Lanes<W, Instructions>> : GenericNumTraits<double> {
  using Real = beamid::filters::algorithms::Lanes<W, Instructions>;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = double;
  // NOLINTBEGIN(readability-identifier-naming): the names are Eigen's
  enum { IsComplex = 0, IsInteger = 0, IsSigned = 1, RequireInitialization = 0 };
  enum { ReadCost = 1, AddCost = 1, MulCost = 1 };
  // NOLINTEND(readability-identifier-naming)
};

// A matrix of lanes times a number, either side.
template <int W, class Instructions, class Operation>
struct Eigen::ScalarBinaryOpTraits<double, beamid::filters::algorithms::Lanes<W, Instructions>, Operation> {
  using ReturnType = beamid::filters::algorithms::Lanes<W, Instructions>;
};
template <int W, class Instructions, class Operation>
struct Eigen::ScalarBinaryOpTraits<beamid::filters::algorithms::Lanes<W, Instructions>, double, Operation> {
  using ReturnType = beamid::filters::algorithms::Lanes<W, Instructions>;
};
