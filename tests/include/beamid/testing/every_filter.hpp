// One registered filter after another, and the motion that its contracts are tested on.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "beamid/testing/known_oscillator.hpp"
#include "filters/filter_run.hpp"

namespace beamid::test {

/// The suite of filter_contracts.hpp, on a registered name.
class EveryFilter : public testing::TestWithParam<std::string> {
 protected:
  static std::unique_ptr<filters::Filter> make(std::unique_ptr<filters::DiscreteModel> model,
                                               const filters::Options& options = {}) {
    return filters::filter_registry().make(GetParam(), options, std::move(model));
  }
  static bool declares(const char* contract) {
    return filters::filter_registry().find(GetParam()).contracts.contains(contract);
  }
  static bool linear_only() { return declares(filters::contract::linear_models_only); }

  /// On the oscillator: [x, v, K, C], or [x, v] alone for filters of linear models.
  static std::unique_ptr<filters::Filter> oscillator(int outputs, double dt, double noise) {
    if (linear_only()) return make(std::make_unique<KnownOscillator>(outputs, dt, noise));
    return make(joint_model(outputs, dt, noise));
  }
  static filters::Gaussian start(const Eigen::Vector4d& mean, const Eigen::Vector4d& variance) {
    const Eigen::Index n = linear_only() ? 2 : 4;
    return {mean.head(n), Eigen::MatrixXd(variance.head(n).asDiagonal())};
  }
};

}  // namespace beamid::test
