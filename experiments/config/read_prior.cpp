#include "experiments/config/read_prior.hpp"

#include "experiments/config/key_tables.hpp"

namespace beamid::experiments {
namespace {

const Schema<Prior>& prior_keys() {
  using P = Prior;
  static const Schema<P> keys =
      Schema<P>("prior")
          .key("stiffness_n_per_m", &P::stiffness, positive, "mean of the stiffness", "515.8")
          .fallback("worked out")
          .key("stiffness_deviation_n_per_m", &P::stiffness_deviation, positive, "its standard deviation",
               "100")
          .fallback("worked out")
          .key("damping_ratio", &P::damping_ratio, {.least = 0.0, .most = 1.0, .below = true},
               "mean of the damping ratio", "0.01")
          .fallback("worked out")
          .key("damping_ratio_deviation", &P::damping_ratio_deviation, positive, "its standard deviation",
               "0.01")
          .fallback("worked out");
  return keys;
}

struct NoiseValues {
  std::string method = "residual";
  std::optional<double> displacement, velocity, acceleration, strain, force, base, support, angular;
};

const Schema<NoiseValues>& noise_keys() {
  using N = NoiseValues;
  static const Schema<N> keys =
      Schema<N>("noise")
          .key(
              "method", &N::method,
              "where the absent ones come from: what the modal analysis, or the nearest motion of the model, "
              "leaves of the record; the level that makes the filter's innovations likeliest, given with "
              "its standard error; the quiet part of the file before the first hit, refused where there is "
              "none of 32 samples",
              "\"likelihood\"")
          .one_of({"residual", "likelihood", "before_event"})
          .key("displacement_m", &N::displacement, positive, "noise of displacement channels", "1e-6")
          .fallback("estimated")
          .key("velocity_m_per_s", &N::velocity, positive, "noise of velocity channels", "1e-5")
          .fallback("estimated")
          .key("acceleration_m_per_s2", &N::acceleration, positive, "noise of acceleration channels", "0.05")
          .fallback("estimated")
          .key("strain_m_per_m", &N::strain, positive, "noise of strain channels", "1e-7")
          .fallback("estimated")
          .key("force_n", &N::force, positive, "noise of measured forces", "0.5")
          .fallback("forces are exact")
          .key("base_acceleration_m_per_s2", &N::base, positive, "noise of the base's measured acceleration",
               "0.01")
          .fallback("it is exact")
          .key("support_acceleration_m_per_s2", &N::support, positive,
               "noise of the accelerations that are imposed at places", "0.01")
          .fallback("they are exact")
          .key("angular_acceleration_rad_per_s2", &N::angular, positive,
               "noise of channels of angular acceleration", "0.01")
          .fallback("estimated");
  return keys;
}

const bool prior_keys_registered[] = {register_keys([]() -> const KeyTable& { return prior_keys(); }),
                                      register_keys([]() -> const KeyTable& { return noise_keys(); })};

}  // namespace

void read_prior(const TomlTable& root, Experiment& experiment) {
  if (const auto table = root.find_table("prior")) experiment.prior = prior_keys().read(*table);
  const auto table = root.find_table("noise");
  if (!table) return;
  const NoiseValues noise = noise_keys().read(*table);
  const auto take = [&](Quantity quantity, const std::optional<double>& deviation) {
    if (deviation) experiment.noise[quantity] = *deviation;
  };
  take(Quantity::displacement, noise.displacement);
  take(Quantity::velocity, noise.velocity);
  take(Quantity::acceleration, noise.acceleration);
  take(Quantity::strain, noise.strain);
  take(Quantity::force, noise.force);
  take(Quantity::base_acceleration, noise.base);
  take(Quantity::support_acceleration, noise.support);
  take(Quantity::angular_acceleration, noise.angular);
  if (table->contains("method")) experiment.noise_method = {noise.method, {}, table->value_place("method")};
}

}  // namespace beamid::experiments
