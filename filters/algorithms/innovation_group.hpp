// The Kalman filters of as many linear models as there are lanes, on one record.
#pragma once

#include <utility>

#include "filters/algorithms/lanes.hpp"

namespace beamid::filters::algorithms {

// Logarithms of long products.

/// Product of many positive normal numbers per lane, as mantissa in [1, 2) and exponent: one logarithm at the
/// end in place of one per factor, and no overflow on the way.
template <class Scalar>
class LogProduct;

template <int W, class Instructions>
class LogProduct<Lanes<W, Instructions>> {
 public:
  using Scalar = Lanes<W, Instructions>;
  using Bits = typename Scalar::Bits;

  void multiply(const Scalar& factor) {
    const Bits bits = std::bit_cast<Bits>((mantissa_ * factor).values);
    exponent_ += (bits >> 52) - 1023;
    mantissa_ =
        std::bit_cast<typename Scalar::Values>((bits & 0x000f'ffff'ffff'ffff) | 0x3ff0'0000'0000'0000);
  }
  double mantissa(int lane) const { return mantissa_[lane]; }
  std::int64_t exponent(int lane) const { return exponent_[lane]; }

 private:
  Scalar mantissa_ = 1.0;
  Bits exponent_ = Bits{};
};

/// Where a group's numbers lie, matrices by columns; plain pointers, so that files compiled for different
/// processors share no code.
struct InnovationGroup {
  static constexpr int most = 4;                  ///< lanes
  std::int64_t states, inputs, outputs, samples;  ///< n, m, p, N
  const double *measured, *known;                 ///< y (p x N), NaN where not read; u (m x N)
  struct Lane {
    const double *a, *g, *h, *d, *q, *r, *mean, *covariance;  ///< as LinearGaussian
    double* innovations;                                      ///< (p x N); of outputs not read, untouched
    double* covariances;    ///< S (p x p) of every step, of outputs read; null where nobody asks
    double sum_of_squares;  ///< sum_k e_k^T S_k^-1 e_k
    double mantissa;        ///< of the product of det S_k
    std::int64_t exponent;
    bool failed;  ///< some S_k is not positive
  } lanes[most];
  std::int64_t* step_of;  ///< (N) samples of one step have one S
  std::int64_t* seen;     ///< (2 p) room
  double* room;           ///< for innovation_room() numbers of every lane, at a multiple of 32 bytes
};

/// How many numbers a lane works with.
constexpr std::int64_t innovation_room(std::int64_t n, std::int64_t m, std::int64_t p) {
  return 6 * n * n + n * m + 4 * p * n + p * m + 2 * p * p + 2 * n + p;
}

/// What kalman_pass() does (filters/linear_gaussian.hpp), S by L D L^T.
template <int W, class Instructions>
class InnovationGroupRun {
 public:
  using Scalar = Lanes<W, Instructions>;
  using Mask = typename Scalar::Mask;
  using Index = std::int64_t;

  explicit InnovationGroupRun(InnovationGroup& group)
      : group_(group), n_(group.states), m_(group.inputs), p_(group.outputs) {
    using Lane = InnovationGroup::Lane;
    a_ = gather(&Lane::a, n_ * n_), q_ = gather(&Lane::q, n_ * n_), g_ = gather(&Lane::g, n_ * m_);
    h_ = gather(&Lane::h, p_ * n_), d_ = gather(&Lane::d, p_ * m_), r_ = gather(&Lane::r, p_ * p_);
    x_ = gather(&Lane::mean, n_), covariance_ = gather(&Lane::covariance, n_ * n_);
    next_ = room(n_ * n_), left_ = room(n_ * n_), kept_ = room(n_ * n_);
    shown_ = room(p_ * n_), gain_ = room(n_ * p_), carried_ = room(n_ * p_);
    s_ = room(p_ * p_), e_ = room(p_), moved_ = room(n_);
  }

  void run() {
    Index step = -1;
    bool steady = false;
    for (Index k = 0; k < group_.samples; ++k) {
      const bool changed = look(k);
      if (!steady || changed || step < 0) {
        if (steady) propagate(), std::swap(covariance_, next_);  // a gap ends the steady state
        steady = false;
        if (changed) now_ = 1 - now_, count_ = waiting_;
        weigh(++step);
      }
      group_.step_of[k] = step;
      correct(k);
      if (k + 1 == group_.samples) break;
      move(k);
      if (steady) continue;
      propagate();
      steady = settled();
      if (!steady) std::swap(covariance_, next_);
    }
    for (int lane = 0; lane < W; ++lane) {
      auto& out = group_.lanes[lane];
      out.sum_of_squares = squares_[lane];
      out.mantissa = product_.mantissa(lane), out.exponent = product_.exponent(lane);
      out.failed = !alive_[lane];
    }
  }

 private:
  using Numbers = Scalar*;

  Numbers room(Index size) {
    const Numbers numbers = reinterpret_cast<Scalar*>(group_.room) + taken_;
    taken_ += size;
    return numbers;
  }
  Numbers gather(const double* InnovationGroup::Lane::*place, Index size) {
    Numbers all = room(size);
    for (Index i = 0; i < size; ++i) {
      typename Scalar::Values values{};
      for (int lane = 0; lane < W; ++lane) values[lane] = (group_.lanes[lane].*place)[i];
      all[i] = values;
    }
    return all;
  }

  const Index* seen() const { return group_.seen + now_ * p_; }

  // Which outputs are read; whether others than before.
  bool look(Index k) {
    Index* const found = group_.seen + (1 - now_) * p_;
    waiting_ = 0;
    for (Index i = 0; i < p_; ++i) {
      const double y = group_.measured[k * p_ + i];
      if (y - y == 0.0) found[waiting_++] = i;  // finite
    }
    bool changed = waiting_ != count_;
    for (Index i = 0; i < waiting_ && !changed; ++i) changed = found[i] != seen()[i];
    return changed;
  }

  // H P, S = L D L^T, K.
  void weigh(Index step) {
    for (Index j = 0; j < n_; ++j)
      for (Index i = 0; i < count_; ++i) {
        Scalar sum = 0.0;
        for (Index l = 0; l < n_; ++l) sum += h_[seen()[i] + l * p_] * covariance_[l + j * n_];
        shown_[i + j * p_] = sum;
      }
    for (Index j = 0; j < count_; ++j)
      for (Index i = j; i < count_; ++i) {
        Scalar sum = r_[seen()[i] + seen()[j] * p_];
        for (Index l = 0; l < n_; ++l) sum += shown_[i + l * p_] * h_[seen()[j] + l * p_];
        s_[i + j * p_] = sum;
        for (int lane = 0; lane < W; ++lane)
          if (double* const kept = group_.lanes[lane].covariances) {
            kept[step * p_ * p_ + seen()[i] + seen()[j] * p_] = sum[lane];
            kept[step * p_ * p_ + seen()[j] + seen()[i] * p_] = sum[lane];
          }
      }
    factorise();
    for (Index j = 0; j < n_; ++j) solve(j);
  }

  // S becomes L below its diagonal and D on it.
  void factorise() {
    for (Index j = 0; j < count_; ++j) {
      alive_ = alive_ & (s_[j + j * p_] > Scalar(0.0));
      const Scalar inverse = 1.0 / s_[j + j * p_];
      for (Index i = j + 1; i < count_; ++i) {
        const Scalar factor = s_[i + j * p_] * inverse;
        for (Index l = i; l < count_; ++l) s_[l + i * p_] -= factor * s_[l + j * p_];
      }
      for (Index i = j + 1; i < count_; ++i) s_[i + j * p_] *= inverse;
    }
  }

  // Row j of K: S^-1 H P e_j.
  void solve(Index j) {
    Scalar* const row = &e_[0];
    for (Index i = 0; i < count_; ++i) {
      row[i] = shown_[i + j * p_];
      for (Index l = 0; l < i; ++l) row[i] -= s_[i + l * p_] * row[l];
    }
    for (Index i = count_; i-- > 0;) {
      row[i] /= s_[i + i * p_];
      for (Index l = i + 1; l < count_; ++l) row[i] -= s_[l + i * p_] * row[l];
      gain_[j + i * n_] = row[i];
    }
  }

  void correct(Index k) {
    for (Index i = 0; i < count_; ++i) {
      Scalar rest = group_.measured[k * p_ + seen()[i]];
      for (Index l = 0; l < n_; ++l) rest -= h_[seen()[i] + l * p_] * x_[l];
      for (Index l = 0; l < m_; ++l) rest -= d_[seen()[i] + l * p_] * Scalar(group_.known[k * m_ + l]);
      e_[i] = rest;
      for (int lane = 0; lane < W; ++lane) group_.lanes[lane].innovations[k * p_ + seen()[i]] = rest[lane];
    }
    for (Index i = 0; i < count_; ++i)
      for (Index j = 0; j < n_; ++j) x_[j] += gain_[j + i * n_] * e_[i];
    for (Index i = 0; i < count_; ++i) {  // L^-1 e
      for (Index l = 0; l < i; ++l) e_[i] -= s_[i + l * p_] * e_[l];
      squares_ += e_[i] * e_[i] / s_[i + i * p_];
      product_.multiply(select(alive_, s_[i + i * p_], Scalar(1.0)));
    }
  }

  void move(Index k) {
    for (Index i = 0; i < n_; ++i) moved_[i] = 0.0;
    for (Index l = 0; l < n_; ++l)
      for (Index i = 0; i < n_; ++i) moved_[i] += a_[i + l * n_] * x_[l];
    for (Index l = 0; l < m_; ++l)
      for (Index i = 0; i < n_; ++i) moved_[i] += g_[i + l * n_] * Scalar(group_.known[k * m_ + l]);
    std::swap(x_, moved_);
  }

  // Rows i .. i + R - 1 of B C or, where it is turned, of B C^T, in column j: sums that stay in registers.
  template <int R, bool Turned>
  void sum_rows(const Scalar* b, const Scalar* c, Index i, Index j, Scalar* to) const {
    Scalar sums[R];
    for (int row = 0; row < R; ++row) sums[row] = 0.0;
    for (Index l = 0; l < n_; ++l) {
      const Scalar factor = c[Turned ? j + l * n_ : l + j * n_];
      for (int row = 0; row < R; ++row) sums[row] += b[i + row + l * n_] * factor;
    }
    for (int row = 0; row < R; ++row) to[i + row + j * n_] += sums[row];
  }

  // to <- to + B C or B C^T, all (n x n); of a symmetric one its lower half and little more.
  template <bool Turned>
  void add_product(const Scalar* b, const Scalar* c, Scalar* to) const {
    constexpr int together = 4;
    for (Index j = 0; j < n_; ++j) {
      Index i = Turned ? j : 0;
      for (; i + together <= n_; i += together) sum_rows<together, Turned>(b, c, i, j, to);
      for (; i < n_; ++i) sum_rows<1, Turned>(b, c, i, j, to);
    }
  }

  // P of the next sample, by Joseph's form [bucy1968] carried through the motion at once: with F = A - A K H,
  // F P F^T + A K R (A K)^T + Q.
  void propagate() {
    for (Index i = 0; i < n_ * n_; ++i) kept_[i] = a_[i], next_[i] = q_[i], left_[i] = 0.0;
    for (Index l = 0; l < count_; ++l)
      for (Index i = 0; i < n_; ++i) {
        Scalar sum = 0.0;
        for (Index o = 0; o < n_; ++o) sum += a_[i + o * n_] * gain_[o + l * n_];
        carried_[i + l * n_] = sum;
      }
    for (Index l = 0; l < count_; ++l)
      for (Index j = 0; j < n_; ++j) {
        const Scalar shown = h_[seen()[l] + j * p_];
        for (Index i = 0; i < n_; ++i) kept_[i + j * n_] -= carried_[i + l * n_] * shown;
      }
    for (Index l = 0; l < count_; ++l)
      for (Index o = 0; o < count_; ++o) {
        const Scalar noise = r_[seen()[o] + seen()[l] * p_];
        for (Index j = 0; j < n_; ++j) {
          const Scalar factor = noise * carried_[j + l * n_];
          for (Index i = j; i < n_; ++i) next_[i + j * n_] += carried_[i + o * n_] * factor;
        }
      }
    add_product<false>(kept_, covariance_, left_);
    add_product<true>(left_, kept_, next_);
    for (Index j = 0; j < n_; ++j)
      for (Index i = j + 1; i < n_; ++i) next_[j + i * n_] = next_[i + j * n_];
  }

  // Whether no lane's P changes any more, in units of its own deviations.
  bool settled() const {
    constexpr double same = 1e-13;
    Mask all_same = Scalar(0.0) == Scalar(0.0);
    for (Index j = 0; j < n_; ++j)
      for (Index i = 0; i <= j; ++i) {
        const Scalar change = next_[i + j * n_] - covariance_[i + j * n_];
        const Scalar size = next_[i + i * n_] * next_[j + j * n_];
        all_same = all_same & (change * change <= same * same * size);
      }
    return all(all_same);
  }

  InnovationGroup& group_;
  Index n_, m_, p_, taken_ = 0, count_ = -1, waiting_ = 0, now_ = 0;
  Numbers a_, g_, h_, d_, q_, r_, x_, covariance_, next_, left_, kept_, shown_, gain_, carried_, s_, e_,
      moved_;
  Mask alive_ = Scalar(0.0) == Scalar(0.0);
  Scalar squares_ = 0.0;
  LogProduct<Scalar> product_;
};

template <int W, class Instructions>
void run_innovations(InnovationGroup& group) {
  InnovationGroupRun<W, Instructions>(group).run();
}

}  // namespace beamid::filters::algorithms
