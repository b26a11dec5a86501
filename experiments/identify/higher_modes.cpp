#include "experiments/identify/higher_modes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "experiments/identify/mode_analysis.hpp"
#include "experiments/modal/shape_fit.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/signal/decimation.hpp"

namespace beamid::experiments {
namespace {

// Largest line of what the mode leaves of the first channel above twice its frequency, as the deviation of
// white noise whose mean line is as high. No window: what a decay begins with is what does harm.
double largest_line(const Record& record, const ModalEstimate& modal) {
  const Eigen::MatrixXd first = record.samples.row(0);
  const ShapeFit fit = fit_shapes(first, record.interval(), {modal.rate(), 0.0}, {true, false});
  const auto count = static_cast<std::size_t>(record.size()), length = std::bit_ceil(count);
  std::vector<double> left(length, 0.0);
  Eigen::Map<Eigen::RowVectorXd>(left.data(), record.size()) = first - fit.reconstruction;
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> lines;
  transform.fwd(lines, left);
  const double from = 2 * modal.frequency_hz * record.interval() * static_cast<double>(length);
  double largest = 0;
  for (auto k = static_cast<std::size_t>(from) + 1; k < lines.size(); ++k)
    largest = std::max(largest, std::norm(lines[k]));
  return std::sqrt(largest / static_cast<double>(count));
}

}  // namespace

std::optional<Choice> step_against_higher_modes(const Experiment& experiment, const Record& record) {
  constexpr double too_large = 6, samples_per_cycle = 8;
  constexpr Eigen::Index enough = 50;  // samples to be left, as the modal analysis wants them
  const RecordAnalysis found = analyse_mode(experiment, record);
  if (!found.modal_refusal.empty()) throw std::invalid_argument(found.modal_refusal);
  if (!found.modal ||
      !(largest_line(found.even.record, *found.modal) > too_large * found.near_mode->deviation))
    return {};
  const int factor = decimation_factor(
      1 / (samples_per_cycle * found.modal->frequency_hz * record.interval()), record.size() / enough);
  constexpr int least = 2, most = 1000;  // of the step
  if (factor < least || factor > most) return {};
  filters::Options options;
  options.set("factor", static_cast<double>(factor));
  return Choice{"decimate", step_registry().completed("decimate", options)};
}

}  // namespace beamid::experiments
