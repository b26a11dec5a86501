#include "experiments/identify/posterior/prior_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/identify/posterior/normal_law.hpp"

namespace beamid::experiments {
namespace {

constexpr double far_tail = 8.0;  // standard deviations beyond which a cut changes no digit

}  // namespace

PriorLaw::PriorLaw(const Unknown& unknown, bool positive, bool stated)
    : lower_(unknown.lower), upper_(unknown.upper) {
  const bool bounded = unknown.form == Form::bounded;
  if (stated && unknown.form == Form::logarithmic) {
    kind_ = Kind::lognormal;
    centre_ = std::log(unknown.guess);
    spread_ = unknown.deviation / unknown.guess;
  } else if (stated) {
    centre_ = unknown.guess;
    spread_ = unknown.deviation;
    if (!bounded && positive) lower_ = 0.0;
    cut_ = (lower_ - centre_) / spread_ > -far_tail || (upper_ - centre_) / spread_ < far_tail;
  } else if (bounded) {
    kind_ = Kind::uniform;
  } else {
    assumed_ = true;
    kind_ = positive && unknown.guess > 0.0 ? Kind::log_uniform : Kind::uniform;
    const double scale = std::max(std::abs(unknown.guess), unknown.deviation);
    lower_ = kind_ == Kind::log_uniform ? std::log(unknown.guess / assumed_factor)
             : positive                 ? 0.0
                                        : unknown.guess - assumed_factor * scale;
    upper_ = kind_ == Kind::log_uniform ? std::log(unknown.guess * assumed_factor)
                                        : unknown.guess + assumed_factor * scale;
  }
}

// Phi(z) = Phi(a) + Phi(u) (Phi(b) - Phi(a)), of the upper tails where u is above zero.
double PriorLaw::standard(double u) const {
  if (!cut_) return u;
  const double a = (lower_ - centre_) / spread_, b = (upper_ - centre_) / spread_;
  if (u > 0.0)
    return -normal_quantile(below_normal(-b) + below_normal(-u) * (below_normal(-a) - below_normal(-b)));
  return normal_quantile(below_normal(a) + below_normal(u) * (below_normal(b) - below_normal(a)));
}

double PriorLaw::value(double u) const {
  if (kind_ == Kind::normal) return std::clamp(centre_ + spread_ * standard(u), lower_, upper_);
  if (kind_ == Kind::lognormal) return std::exp(centre_ + spread_ * u);
  const double place =
      u > 0.0 ? upper_ - (upper_ - lower_) * below_normal(-u) : lower_ + (upper_ - lower_) * below_normal(u);
  return kind_ == Kind::log_uniform ? std::exp(place) : place;
}

double PriorLaw::slope(double u) const {
  if (kind_ == Kind::normal && !cut_) return spread_;
  if (kind_ == Kind::normal) {
    const double a = (lower_ - centre_) / spread_, b = (upper_ - centre_) / spread_;
    return spread_ * normal_density(u) * (below_normal(b) - below_normal(a)) / normal_density(standard(u));
  }
  if (kind_ == Kind::lognormal) return spread_ * value(u);
  const double slope = (upper_ - lower_) * normal_density(u);
  return kind_ == Kind::log_uniform ? slope * value(u) : slope;
}

std::optional<double> PriorLaw::place(double p) const {
  double u = std::numeric_limits<double>::quiet_NaN();
  if (kind_ == Kind::lognormal) {
    u = (std::log(p) - centre_) / spread_;
  } else if (kind_ == Kind::normal) {
    const double z = (p - centre_) / spread_;
    const double a = (lower_ - centre_) / spread_, b = (upper_ - centre_) / spread_;
    if (!(p > lower_ && p < upper_)) return {};
    const double whole = below_normal(b) - below_normal(a);
    u = !cut_     ? z
        : z > 0.0 ? -normal_quantile((below_normal(-z) - below_normal(-b)) / whole)
                  : normal_quantile((below_normal(z) - below_normal(a)) / whole);
  } else {
    const double share = ((kind_ == Kind::log_uniform ? std::log(p) : p) - lower_) / (upper_ - lower_);
    if (!(share > 0.0 && share < 1.0)) return {};
    u = share > 0.5 ? -normal_quantile(1.0 - share) : normal_quantile(share);
  }
  if (!(std::abs(u) < far_tail)) return {};
  return u;
}

std::string PriorLaw::text() const {
  std::string text;
  if (kind_ == Kind::uniform) text = fmt::format("uniform from {:.5g} to {:.5g}", lower_, upper_);
  if (kind_ == Kind::log_uniform)
    text = fmt::format("log-uniform from {:.5g} to {:.5g}", std::exp(lower_), std::exp(upper_));
  if (kind_ == Kind::lognormal)
    text = fmt::format("lognormal, median {:.5g}, {:.3g} %", std::exp(centre_), 100.0 * spread_);
  if (kind_ == Kind::normal) text = fmt::format("normal, {:.5g} +- {:.3g}", centre_, spread_);
  if (kind_ == Kind::normal && std::isfinite(upper_))
    text += fmt::format(", within {:.5g} and {:.5g}", lower_, upper_);
  return assumed_ ? text + " (assumed)" : text;
}

}  // namespace beamid::experiments
