// Posteriors whose truth is known otherwise, for tests.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "experiments/identify/posterior/posterior.hpp"
#include "experiments/identify/posterior/posterior_study.hpp"
#include "experiments/identify/update/modal_model.hpp"
#include "tests/experiments/identify/update/update_cases.hpp"

namespace beamid::experiments {

/// A structure, measured modes and their likelihood, kept together.
struct ModalCase {
  std::unique_ptr<const ModalModel> model;
  std::unique_ptr<const SearchSpace> space;
  std::unique_ptr<const ModalResidual> residual;
  std::unique_ptr<const ModalLikelihood> likelihood;
};
ModalCase modal_case(const Experiment& experiment, const ModalData& data, ModelTrust trust = {0.0, 0.0});

/// Two storeys of masses 0.52 and 0.26 as described, 958.61 each (kips and inches of the published chain,
/// which scale out; github.com/NHERI-SimCenter/quoFEM); `prior` is text of each [[parameters]].
Experiment two_storeys(const std::string& prior);
/// Its frequencies in closed form [Hz].
std::vector<double> two_storey_frequencies(double lower, double upper);
/// Frequencies with one standard deviation, a part of each.
ModalData measured_frequencies(const std::vector<double>& frequencies_hz, double relative);

}  // namespace beamid::experiments
