#include "experiments/identify/sensing/filtered_rows.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "filters/running_filter.hpp"
#include "filters/unknown_inputs.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

bool estimates_unknown_inputs(const std::string& filter) {
  return filters::filter_registry().find(filter).contracts.contains(filters::contract::unknown_inputs);
}

FilteredRows filtered_rows(SensingForm form, const Choice& filter, const filters::Measurements& record,
                           const MatrixXd& rows, const MatrixXd& feed) {
  const auto made = filters::filter_registry().make(filter.name, filter.options, std::move(form.model));
  filters::RunningFilter run(*made);
  run.start(form.start);
  const Index n = record.size();
  FilteredRows result{{MatrixXd(rows.rows(), n), MatrixXd(rows.rows(), n)}, {}};
  for (Index k = 0; k < n; ++k) {
    const VectorXd input = record.inputs.size() > 0 ? VectorXd(record.inputs.col(k)) : VectorXd();
    if (!run.take_in({record.time[k], record.outputs.col(k), input}))
      throw std::runtime_error(
          fmt::format("{} failed at {:.6g} s: {}", filter.name, run.failure()->time, run.failure()->reason));
    const filters::Gaussian estimate = made->marginal(form.moving);
    result.rows.means.col(k) = rows * estimate.mean;
    if (input.size() > 0) result.rows.means.col(k) += feed * input;
    result.rows.deviations.col(k) =
        (rows * estimate.covariance * rows.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
  }
  result.remarks = made->remarks();
  return result;
}

}  // namespace beamid::experiments
