#include "experiments/identify/compare/described_response.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "experiments/identify/compare/against_description.hpp"
#include "experiments/identify/model_setting.hpp"
#include "experiments/models/joint_model.hpp"
#include "filters/sample_walk.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// (p x N)
MatrixXd response_as_described(const JointModel& model, const filters::Measurements& record) {
  const Index p = record.outputs.rows();
  VectorXd start = VectorXd::Zero(static_cast<Index>(model.motion->state_labels().size())), output(p);
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    start[model.unknown_places[j]] = model.unknowns[j].to_state(model.unknowns[j].guess);
  const auto discrete = finest(model, record.interval(), MatrixXd::Identity(p, p));
  MatrixXd response(p, record.size()), no_directions(start.size(), 0);
  filters::walk_samples(*discrete, record, record.size(), start, no_directions,
                        [&](Index step, const auto& x, const auto& input) {
                          discrete->output(x, input, output);
                          response.col(step) = output;
                        });
  return response;
}

}  // namespace

std::string described_response_text(const RunContext& context, const ComparedRun& run) {
  constexpr double far = 4.0, alike = 0.5, near = 0.25;  // near: of a logarithm
  if (!context.analysis.forced() || !run.model) return {};
  try {
    const filters::Measurements record = measurements(context.analysis.record);
    const MatrixXd response = response_as_described(*run.model, record);
    if (!response.allFinite()) return {};
    double sizes = 0.0, product = 0.0;
    for (Index i = 0; i < response.rows(); ++i) {
      const auto read = record.outputs.row(i).array().isFinite();
      const Eigen::ArrayXd y = read.select(record.outputs.row(i).array(), 0.0).transpose(),
                           d = read.select(response.row(i).array(), 0.0).transpose();
      const double square = std::max(y.square().sum(), 1e-300);
      sizes += d.square().sum() / square;
      product += (y * d).sum() / square;
    }
    const double channels = static_cast<double>(response.rows()), gain = std::sqrt(sizes / channels);
    const bool turned = product < -alike * gain * channels;
    if (!(gain > 0.0) || (!turned && gain < far && far * gain > 1.0)) return {};
    return fmt::format(
        "The structure as described, moved by the measured input, moves {:.3g} times as much as the record "
        "shows{}{}. The unit, gain or sign of the input or of the motion is the likely cause: check "
        "[record].",
        gain, turned ? ", and against it" : "", usual_scale(gain, near));
  } catch (const std::exception&) {  // a guess that has no motion
    return {};
  }
}

}  // namespace beamid::experiments
