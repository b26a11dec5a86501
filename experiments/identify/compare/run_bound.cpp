#include "experiments/identify/compare/run_bound.hpp"

#include <cmath>

#include "filters/fisher_information.hpp"
#include "filters/identifiability.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

VectorXd run_bounds(filters::DiscreteModel& discrete, const JointModel& model, const VectorXd& state,
                    const StartDirections& directions, const filters::Measurements& record) {
  filters::InformationFactor information =
      filters::information_factor(discrete, state, record.time.size(), directions.all(), record.inputs);
  const Index first = directions.motion.cols(), all = information.unknowns();
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    if (model.unknowns[j].nuisance)
      information.add(MatrixXd::Identity(all, all).row(first + static_cast<Index>(j)));
  const auto slips = static_cast<Index>(model.slips.size());
  for (Index i = first - slips; i < first; ++i) information.add(MatrixXd::Identity(all, all).row(i));
  VectorXd bound =
      filters::determined_combinations(information, VectorXd::Ones(all)).bounds.tail(all - first);
  const double read = record.outputs.array().isFinite().cast<double>().mean();  // share of the samples
  for (Index j = 0; j < bound.size(); ++j) {
    const Index place = model.unknown_places[j];
    bound[j] *=
        directions.unknowns(place, j) * std::abs(model.unknowns[j].slope(state[place])) / std::sqrt(read);
  }
  return bound;
}

}  // namespace beamid::experiments
