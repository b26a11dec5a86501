// Who is to blame: the error of a pipeline, shared out among its causes.
#pragma once

#include <string>
#include <vector>

#include "experiments/studies/budget/pipeline.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

/// One cause's part in the error, counted in four ways [% of K and of C].
struct Contribution {
  ParameterErrors alone;        ///< e({i}) - e({}): switched on in the clean pipeline
  ParameterErrors without;      ///< e(all) - e(all but i): what switching it off alone would take away
  ParameterErrors in_sequence;  ///< e({1..i}) - e({1..i-1}): from the beam to the filter; adds up
  ParameterErrors average;      ///< over several orders, each of which adds up: so does this
};

/// e is the error with a set of causes on.
struct Budget {
  std::string name;
  Pipeline pipeline;
  ParameterErrors clean, total;             ///< e({}), e(all)
  std::vector<Contribution> contributions;  ///< in the order of `causes`
  ParameterErrors interaction;              ///< total - clean - sum of `alone`
  int runs = 0;                             ///< filters that were run
};

/// The budget of one pipeline.
///
/// The average is Shapley's value [shapley1953] over all orders, here over `orders` of them: the pipeline's
/// own, its reverse, then random ones in pairs with their reverses, seeded as the noise is.
/// @throws std::invalid_argument when orders < 2
Budget make_budget(
    const std::string& name, const PipelineSettings& settings, int orders,
    const Progress& progress = [](const std::string&) {});

/// Index of the cause whose contribution is largest in absolute value.
std::size_t largest(const std::vector<Contribution>& contributions, ParameterErrors Contribution::*way,
                    double ParameterErrors::*parameter);

}  // namespace beamid::experiments
