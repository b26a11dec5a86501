#include "experiments/modal/study/pole_levels.hpp"

#include <algorithm>
#include <cmath>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

int factor_for(const Record& record, double highest_hz) {
  constexpr double passed = 0.3;  // of the new sampling rate, untouched by the decimation
  return decimation_factor(passed / (record.interval() * highest_hz), record.size() / 100);
}

/// Where a level that reaches up to `top` ends: at an eighth of it, away from any line, or at the band's own
/// beginning.
double bottom_of(double top, const std::vector<RecordLine>& lines, const RecordModes& found) {
  constexpr double span = 8, margin = 1.15;
  double bottom = top / span;
  const auto beside = [&](const RecordLine& line) {
    return line.frequency_hz < margin * bottom && line.frequency_hz > bottom / margin;
  };
  while (std::any_of(lines.begin(), lines.end(), beside)) bottom /= margin;
  const bool needed = std::any_of(lines.begin(), lines.end(), [&](const RecordLine& line) {
    return line.frequency_hz >= found.band_hz.first && line.frequency_hz < bottom;
  });
  return needed && factor_for(found.record, bottom) > factor_for(found.record, top) ? bottom
                                                                                    : found.band_hz.first;
}

void choose(StabilisationSettings settings, const std::vector<OrderPoles>& orders, RecordModes& found) {
  const Stabilisation level = stabilise(orders, settings);
  const auto append = [](auto& to, const auto& from) { to.insert(to.begin(), from.begin(), from.end()); };
  append(found.stabilisation.poles, level.poles);
  append(found.stabilisation.modes, level.modes);
  append(found.stabilisation.rejected, level.rejected);
}

}  // namespace

CoarseRecord coarse_record(const Record& record, double highest_hz) {
  CoarseRecord coarse;
  const int factor = factor_for(record, highest_hz);
  for (Index i = 0; i < record.samples.rows(); ++i) {
    coarse.last = decimate(record.samples.row(i).transpose(), record.interval(), factor);
    if (i == 0) coarse.samples.resize(record.samples.rows(), coarse.last.samples.size());
    coarse.samples.row(i) = coarse.last.samples.transpose();
  }
  return coarse;
}

void search_levels(const ModalMethod& method, const ModalStudySettings& settings, const VectorXd& scales,
                   const std::vector<RecordLine>& lines, const CoarseRecord& finest, RecordModes& found) {
  CoarseRecord level = finest;
  double top = found.band_hz.second;
  for (bool first = true;; first = false) {
    PoleSearch search = method.search(scales.cwiseInverse().asDiagonal() * level.samples, level.last.interval,
                                      settings.largest_order);
    const double bottom = found.free_decay ? bottom_of(top, lines, found) : found.band_hz.first;
    StabilisationSettings stable = settings.stabilisation;
    stable.band_hz = {bottom, top};
    if (found.free_decay)
      stable.resolution_hz = 1 / (level.last.interval * static_cast<double>(level.samples.cols()));
    choose(stable, search.orders, found);
    if (first) found.search = std::move(search);
    if (bottom <= found.band_hz.first) break;
    level = coarse_record(found.record, bottom);
    top = bottom;
  }
  for (const PoleCluster& cluster : found.stabilisation.modes)
    found.modes.push_back({cluster.pole, cluster.orders});
}

}  // namespace beamid::experiments
