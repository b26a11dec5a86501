#include "experiments/identify/update/remedies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "experiments/identify/update/least_squares.hpp"
#include "experiments/signal/chi_square_limit.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr std::size_t most_remedies = 3, remedy_starts = 3, most_exchanged_sensors = 12;

/// The measurement as it would be without one error.
struct Remedied {
  std::string sentence;  ///< "Without the mode at 3 Hz"
  ModalData data;
  std::vector<fem::Point> points;  ///< of the shapes
  std::string question;
};

std::string sensor_name(const Experiment& experiment, std::size_t sensor) {
  const std::string& name = experiment.sensors[sensor].name;
  return name.empty() ? fmt::format("{}", sensor + 1) : fmt::format("'{}'", name);
}

void without_modes(const RemedyRequest& request, std::vector<Remedied>& all) {
  for (std::size_t i = 0; i < request.data.modes.size() && request.data.modes.size() > 1; ++i) {
    all.push_back({fmt::format("Without the mode at {:.4g} Hz", request.data.modes[i].frequency_hz),
                   request.data, request.model.points(),
                   "is it one of the structure's, and measured as described?"});
    all.back().data.modes.erase(all.back().data.modes.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

void with_a_mode_missing(const RemedyRequest& request, std::vector<Remedied>& all) {
  const auto count = static_cast<Index>(request.data.modes.size());
  for (const MeasuredMode& mode : request.data.modes)
    if (mode.number || request.model.modes() <= count) return;
  for (Index missing = 0; missing < count; ++missing) {
    all.push_back({fmt::format("Were mode {} missing in the file, then", missing + 1), request.data,
                   request.model.points(), "if it was not found, say so by the key 'mode' of [[modes]]."});
    for (Index i = 0; i < count; ++i)
      all.back().data.modes[static_cast<std::size_t>(i)].number =
          static_cast<int>(i < missing ? i + 1 : i + 2);
  }
}

void without_a_sensor(const RemedyRequest& request, std::vector<Remedied>& all) {
  const std::size_t sensors = request.model.points().size();
  for (std::size_t s = 0; s < sensors && sensors > 2; ++s) {
    all.push_back({fmt::format("Without sensor {}", sensor_name(request.experiment, s)), request.data,
                   request.model.points(), "are its gain, place and direction as described?"});
    all.back().points.erase(all.back().points.begin() + static_cast<std::ptrdiff_t>(s));
    for (MeasuredMode& mode : all.back().data.modes) {
      if (mode.shape.size() < 2) continue;
      const VectorXd whole = mode.shape;
      mode.shape.resize(whole.size() - 1);
      for (Index i = 0; i < mode.shape.size(); ++i)
        mode.shape[i] = whole[i < static_cast<Index>(s) ? i : i + 1];
    }
  }
}

void with_sensors_exchanged(const RemedyRequest& request, std::vector<Remedied>& all) {
  const std::size_t sensors = std::min(request.model.points().size(), most_exchanged_sensors);
  for (std::size_t a = 0; a < sensors; ++a)
    for (std::size_t b = a + 1; b < sensors; ++b) {
      all.push_back({fmt::format("With sensors {} and {} exchanged", sensor_name(request.experiment, a),
                                 sensor_name(request.experiment, b)),
                     request.data, request.model.points(), "does each sit where the file says?"});
      for (MeasuredMode& mode : all.back().data.modes)
        if (mode.shape.size() > 1)
          std::swap(mode.shape[static_cast<Index>(a)], mode.shape[static_cast<Index>(b)]);
    }
}

std::optional<Remedy> fitted(const RemedyRequest& request, const Remedied& one) {
  const ModalModel model(request.experiment.structure, request.experiment.elements, one.points,
                         request.model.asked(), request.model.modes());
  const ModalResidual residual(model, request.space, one.data, request.trust);
  std::optional<Fit> best = least_squares(residual, request.updating.best().fit.x);
  for (std::size_t start = 0; start < remedy_starts; ++start)
    if (auto fit = least_squares(residual, request.space.start(start));
        fit && (!best || fit->chi_square() < best->chi_square()))
      best = std::move(fit);
  if (!best) return std::nullopt;
  const Index determined = request.updating.independent - request.updating.freedom,
              freedom = residual.independent(best->value) - determined;
  if (freedom < 1) return std::nullopt;
  const double limit = chi_square_limit(static_cast<double>(freedom));
  if (best->chi_square() > limit) return std::nullopt;
  return Remedy{fmt::format("{} these parameters explain the modes (chi^2 = {:.3g}, limit {:.3g}): {}",
                            one.sentence, best->chi_square(), limit, one.question),
                best->chi_square()};
}

}  // namespace

std::vector<Remedy> remedies(const RemedyRequest& request) {
  std::vector<Remedied> all;
  without_modes(request, all);
  if (request.data.has_shapes()) {
    without_a_sensor(request, all);
    with_sensors_exchanged(request, all);
  } else {
    with_a_mode_missing(request, all);
  }
  std::vector<Remedy> found;
  for (const Remedied& one : all)
    if (auto remedy = fitted(request, one)) found.push_back(std::move(*remedy));
  std::stable_sort(found.begin(), found.end(),
                   [](const Remedy& a, const Remedy& b) { return a.chi_square < b.chi_square; });
  std::erase_if(found, [best = found.empty() ? 0.0 : found.front().chi_square](const Remedy& one) {
    return one.chi_square > best + as_well_chi_square;
  });
  if (found.size() > most_remedies) found.resize(most_remedies);
  return found;
}

}  // namespace beamid::experiments
