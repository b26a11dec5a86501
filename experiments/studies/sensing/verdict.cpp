// Whether what was sensed may be relied on, and what contradicts it.
#include <fmt/format.h>

#include <cmath>

#include "experiments/studies/sensing/report.hpp"

namespace beamid::experiments {
namespace {

// A part of a whole that may be next to nothing.
std::string share(double part, double whole) {
  constexpr double most = 10.0;
  return part <= most * whole ? fmt::format("{:.0f} %", 100.0 * part / whole) : "more than 1000 %";
}

}  // namespace

void add_sensing_verdict(const SensingStudy& study, Results& results) {
  if (!study.converged)
    results.warning(
        "The constants were not found: " + study.failure + ". All below is where the search ended.", true);
  for (const SensorNoise& one : study.noise)
    if (one.explains_too_much())
      results.warning(
          fmt::format("{}: {} of what it read is taken for noise that is not stated, {:.3g} {}. The "
                      "structure, a sensor's place or unit, or the places of the unknown forces are not "
                      "as described.",
                      one.name, share(one.deviation, one.root_mean_square), one.deviation, one.unit),
          true);
  std::size_t free = 0;
  for (const LeftOutSensor& one : study.left_out) {
    if (one.contradicts())
      results.warning(fmt::format("{}: the other sensors predict it with an error of {:.3g} {}, {:.2g} times "
                                  "what they report. The structure, a sensor's place or unit, or the places "
                                  "of the unknown forces are not as described.",
                                  one.name, one.error, one.unit, one.error / one.expected),
                      true);
    free += one.free() ? 1 : 0;
  }
  if (study.left_out.empty())
    results.warning(
        study.forces.empty()
            ? "One sensor alone: no other checks it, its place or its unit."
            : "One sensor alone: no other checks the structure as described, and its errors become "
              "force.");
  else if (free == study.left_out.size())
    results.warning(
        "No sensor can be predicted from the others: any record would fit, and no sensor checks the "
        "structure "
        "as described. A sensor more would.");
  else if (study.is_to_rely_on())
    results.paragraph(fmt::format(
        "{} of {} sensors are predicted by the others as well as their standard deviations state.",
        study.left_out.size() - free, study.left_out.size()));
  if (study.unseen_constants > 0)
    results.warning(fmt::format(
        "{} cannot be seen: these sensors read the same of {} as of rest. Means of forces, "
        "displacements and strains are not known, and no error below holds them; what changes "
        "slowly is known from the correlation time only. One displacement or strain would determine them.",
        study.forces.size() == 1 ? "A constant force"
        : study.unseen_constants == 1
            ? "One combination of constant forces"
            : std::to_string(study.unseen_constants) + " combinations of constant forces",
        study.unseen_constants == 1 ? "it" : "them"));
  for (const SoleZero& zero : study.sole_zeros) {
    std::string moved;
    for (std::size_t j = 0; j < zero.shifts.size() && j < study.histories.size(); ++j)
      if (std::abs(zero.shifts[j]) > 1e-3 * study.histories[j].reported_error())
        moved += fmt::format("{}{} by {:.3g} {}", moved.empty() ? "" : ", ", study.histories[j].name,
                             zero.shifts[j], study.histories[j].unit);
    results.warning(fmt::format(
        "Means rest on the zero of {} alone, which is taken for exact: no other sensor distinguishes an "
        "offset of it from a constant force. Off by {:g} {} it shifts {}. The errors below do not "
        "hold it.",
        zero.name, zero.off, zero.unit, moved));
  }
  for (const SensedHistory& one : study.histories)
    if (one.undetermined())
      results.warning(
          fmt::format("{}: not determined by these sensors; its error is {} of what it would be without "
                      "any.",
                      one.name, share(one.reported_error(), one.unread_deviation)));
  for (const SensedHistory& one : study.histories)
    if (one.contradicts_smoother())
      results.warning(
          fmt::format("{} has failed: its {} is {:.2g} {} from the smoother's, which sees the same "
                      "readings; it reports an error of {:.2g}.",
                      study.filter, one.name, one.from_smoother, one.unit, one.reported_error()),
          true);
  const double square = study.innovations.mean_normalised_square,
               correlation = study.innovations.lag_one_correlation;
  if (square > SensingStudy::largest_square)
    results.warning(
        fmt::format(
            "From sample to sample the sensors read {:.2g} times as far from what is expected of them "
            "as they should: structure, sensors or forces are not as described.",
            std::sqrt(square)),
        true);
  else if (study.coloured())
    results.warning(
        fmt::format(
            "Innovations are correlated from sample to sample, {:.2f}: the force is not such a process, "
            "or the structure not quite as described. {}.",
            correlation,
            study.correlated() ? "Standard deviations, and intervals of parameters above all, are too small"
                               : "Standard deviations may be too small"),
        study.correlated());
  if (square <= SensingStudy::largest_square && study.noisier_than_stated())
    results.warning(
        fmt::format("From sample to sample the sensors read {:.2f} times as far from what is expected of "
                    "them as they should. The noise is larger than stated, or forces are. Standard "
                    "deviations and intervals are too small by "
                    "as much.",
                    std::sqrt(square)));
}

}  // namespace beamid::experiments
