// The Bouc-Wen spring: part of it slips and remembers [wen1976],
//
//     r = alpha k d + (1 - alpha) k h,    h' = d' - |h/l|^(n-1) (beta |d'| h + gamma d' |h|)
//
// The slip carried is s = d - h in place of h: small motion then is that of the spring k, with s at rest.
// beta and gamma are in 1/m whatever n is; l, of no effect at n = 1, is the displacement at which an exponent
// above one yields as n = 1 does. Under monotonic motion h tends to 1 / (beta + gamma) at n = 1: the drift at
// which the storey yields.
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "experiments/models/springs/spring_law.hpp"

namespace beamid::experiments {
namespace {

struct BoucWenValues {
  double ratio, beta, gamma, exponent, length;
};

void require(bool met, const char* name, double value, const char* expected) {
  if (!met) throw std::invalid_argument(fmt::format("{} is {:g}; expected {}", name, value, expected));
}

class BoucWenSpring final : public SpringLaw {
 public:
  explicit BoucWenSpring(const BoucWenValues& values) : values_(values) {
    require(values.ratio >= 0.0 && values.ratio <= 1.0, "post_yield_ratio", values.ratio,
            "a number from 0 to 1");
    require(values.beta >= 0.0, "hysteresis_beta", values.beta,
            "zero or more: below it the spring gives energy");
    require(values.beta + values.gamma >= 0.0, "hysteresis_gamma", values.gamma,
            "at least -hysteresis_beta: below it the slip does not end");
    require(values.exponent >= 1.0, "exponent", values.exponent, "at least 1");
    require(values.length > 0.0, "reference_length_m", values.length, "more than 0");
  }

  bool slips() const override { return true; }
  std::vector<SpringParameter> parameters() const override {
    return {{{"post_yield_ratio", "", ""}, values_.ratio},
            {{"hysteresis_beta", "1/m", "per_m"}, values_.beta},
            {{"hysteresis_gamma", "1/m", "per_m"}, values_.gamma}};
  }
  // p = [k, alpha, beta, gamma]
  void evaluate(double d, double v, double s, const SpringVector& p, SpringForce& f) const override {
    const double h = d - s, size = std::abs(h), speed = std::abs(v), n = values_.exponent;
    const double power = n == 1.0 ? 1.0 : std::pow(size / values_.length, n - 1.0);
    f.value = p[0] * d - (1.0 - p[1]) * p[0] * s;
    f.by_drift = p[0];
    f.by_slip = -(1.0 - p[1]) * p[0];
    f.by_parameter << d - (1.0 - p[1]) * s, p[0] * s, 0.0, 0.0;
    f.slip_rate = power * (p[2] * speed * h + p[3] * v * size);
    f.slip_by_drift = n * power * (p[2] * speed + p[3] * v * std::copysign(1.0, h));
    f.slip_by_slip = -f.slip_by_drift;
    f.slip_by_rate = power * (p[2] * std::copysign(1.0, v) * h + p[3] * size);
    f.slip_by_parameter << 0.0, 0.0, power * speed * h, power * v * size;
  }

 private:
  BoucWenValues values_;
};

const bool bouc_wen_spring_registered = spring_law_registry().add(
    {"bouc_wen",
     "hysteresis: a part of the spring slips, and stays where it stops",
     "[wen1976]",
     {{"post_yield_ratio", 0.5, "", "alpha, the part of k that does not slip"},
      {"hysteresis_beta_per_m", 0.0, "1/m", "beta; 1 / (beta + gamma) is the drift at which it yields"},
      {"hysteresis_gamma_per_m", 0.0, "1/m", "gamma"},
      {"exponent", 1.0, "", "n, at least 1"},
      {"reference_length_m", 1e-3, "m", "l, of no effect at n = 1"}},
     {},
     [](const filters::Options& o) {
       return std::make_unique<BoucWenSpring>(BoucWenValues{
           o.number("post_yield_ratio"), o.number("hysteresis_beta_per_m"),
           o.number("hysteresis_gamma_per_m"), o.number("exponent"), o.number("reference_length_m")});
     }});

}  // namespace
}  // namespace beamid::experiments
