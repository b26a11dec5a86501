#include "experiments/studies/paper/alternatives.hpp"

#include <tbb/parallel_for.h>

#include "experiments/studies/paper/alternative_chains.hpp"
#include "experiments/studies/paper/errors.hpp"

namespace beamid::experiments::paper {
namespace {

using Eigen::Index, Eigen::VectorXd;

Identification identify_chain(const BeamCase& beam, const ChainMotion& motion, double process_variance) {
  const Index count = beam.released.time.size() - motion.first;
  filters::Measurements record{beam.released.time.tail(count), Eigen::MatrixXd(2, count), {}};
  record.outputs << motion.displacement.tail(count).transpose(), motion.velocity.tail(count).transpose();
  BeamSettings settings = wide_settings(beam);
  settings.process_variance = process_variance;
  return identify(beam, record, settings, "ekf", "exponential");
}

}  // namespace

std::vector<AlternativeCase> examine_alternatives(const std::vector<const BeamCase*>& beams) {
  std::vector<AlternativeCase> cases;
  const auto count = static_cast<Index>(beams.size());
  for (const Alternative& alternative : compared_alternatives())
    cases.push_back({alternative.name, VectorXd(count), VectorXd(count), VectorXd(count)});
  tbb::parallel_for(Index{0}, count, [&](Index b) {
    const BeamCase& beam = *beams[static_cast<std::size_t>(b)];
    const CleanMode mode = clean_mode(beam);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const ChainMotion motion = compared_alternatives()[i].chain(mode);
      const Oscillator quiet = identify_chain(beam, motion, 0.0).found,
                       noisy = identify_chain(beam, motion, alternative_process_variance).found;
      cases[i].damping_error_percent[b] = damping_error(quiet, beam.reference);
      cases[i].stiffness_error_percent[b] = stiffness_error(quiet, beam.reference);
      cases[i].noisy_damping_error_percent[b] = damping_error(noisy, beam.reference);
    }
  });
  return cases;
}

Table alternative_table(const std::vector<AlternativeCase>& cases) {
  Table table{"alternatives",
              "Other causes, one at a time, before the exact filter: error of C on five beams [%]"};
  table.column({"done to a clean first mode", "alternative"})
      .column({"K, largest [%]", "largest_stiffness_error_percent", "{:.4f}"})
      .column({"C, least [%]", "least_damping_error_percent", "{:+.3f}"})
      .column({"C, largest [%]", "largest_damping_error_percent", "{:+.3f}"})
      .column({"C with Q, least [%]", "least_damping_error_with_process_noise_percent", "{:+.3f}"})
      .column({"C with Q, largest [%]", "largest_damping_error_with_process_noise_percent", "{:+.3f}"});
  for (const AlternativeCase& one : cases)
    table.row({one.name, one.stiffness_error_percent.cwiseAbs().maxCoeff(),
               one.damping_error_percent.minCoeff(), one.damping_error_percent.maxCoeff(),
               one.noisy_damping_error_percent.minCoeff(), one.noisy_damping_error_percent.maxCoeff()});
  table.note =
      "The chain of 2009 (high-pass at 0.5 Hz, R = 1e-5 I, P0 of K and C 1e5) on 25 s of the first mode "
      "alone, no noise. With Q: process noise of 1e-8 of x and v per step, which the digits of table 2 "
      "exclude.";
  return table;
}

}  // namespace beamid::experiments::paper
