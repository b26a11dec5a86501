#include "experiments/modal/hammer_response.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>
#include <unsupported/Eigen/FFT>

#include "experiments/modal/hit_sampling.hpp"
#include "experiments/signal/onsets.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

/// What a peak reaches to one side: down to half its power, or to the valley before a larger value.
struct Side {
  Index end;            ///< the last line still above half power
  double valley;        ///< smallest power before a larger one
  bool larger = false;  ///< whether a larger one comes
};

Side side_of(const VectorXd& power, Index peak, Index direction) {
  Side side{peak, power[peak]};
  bool above = true;
  for (Index k = peak + direction; k >= 0 && k < power.size(); k += direction) {
    if (power[k] > power[peak]) {
      side.larger = true;
      break;
    }
    above = above && power[k] >= 0.5 * power[peak] && power[k] <= power[k - direction];
    if (above) side.end = k;
    side.valley = std::min(side.valley, power[k]);
  }
  return side;
}

struct LocalFit {
  Complex rate;
  double misfit;  ///< what is left of the lines, over the mode's own part of them
};

/// Of the lines [first, first + count).
LocalFit local_fit(const VectorXcd& s, const MatrixXcd& receptance, Index first, Index count) {
  const Index outputs = receptance.rows();
  MatrixXcd matrix = MatrixXcd::Zero(outputs * count, 1 + 2 * outputs);
  VectorXcd right(outputs * count);
  const Complex centre = s[first + count / 2];  // the same equation in s - centre, whose numbers are small
  for (Index o = 0; o < outputs; ++o) {
    const double scale = 1 / std::max(receptance.row(o).segment(first, count).norm(), 1e-300);
    for (Index k = 0; k < count; ++k) {
      const Complex h = scale * receptance(o, first + k), from = s[first + k] - centre;
      matrix(o * count + k, 0) = h;
      matrix(o * count + k, 1 + 2 * o) = from;
      matrix(o * count + k, 2 + 2 * o) = 1;
      right[o * count + k] = from * h;
    }
  }
  const VectorXcd parts = complex_least_squares(matrix, right);
  const VectorXcd left = matrix * parts - right;
  double squares = 0, own = 0;
  for (Index o = 0; o < outputs; ++o)
    for (Index k = 0; k < count; ++k) {
      const Complex from = s[first + k] - centre - parts[0];
      squares += std::norm(left[o * count + k] / from);
      own += std::norm((parts[2 + 2 * o] + parts[1 + 2 * o] * parts[0]) / from);
    }
  return {centre + parts[0], std::sqrt(squares / std::max(own, 1e-300))};
}

}  // namespace

std::vector<Pole> poles_at_peaks(const VectorXd& frequency_hz, const MatrixXcd& responses, double shift,
                                 int power, double smallest) {
  constexpr double above_valley = 1.2, largest_misfit = 0.1;
  const Index lines = frequency_hz.size();
  VectorXcd s(lines);
  VectorXd mobility(lines);
  MatrixXcd receptance(responses.rows(), lines);
  for (Index k = 0; k < lines; ++k) {
    s[k] = Complex(shift, 2 * std::numbers::pi * frequency_hz[k]);
    receptance.col(k) = responses.col(k) / std::pow(s[k], power);
    mobility[k] = receptance.col(k).squaredNorm() * std::norm(s[k]);
  }
  const double least = smallest * smallest * mobility.maxCoeff();
  std::vector<Pole> poles;
  for (Index k = 1; k + 1 < lines; ++k) {
    if (mobility[k] < least || mobility[k] < mobility[k - 1] || mobility[k] <= mobility[k + 1]) continue;
    const Side left = side_of(mobility, k, -1), right = side_of(mobility, k, 1);
    const double valley = std::max(left.larger ? left.valley : 0, right.larger ? right.valley : 0);
    if (mobility[k] < above_valley * above_valley * valley) continue;
    const Index first = std::max<Index>(0, std::min(left.end, k - 2)),
                last = std::min(lines - 1, std::max(right.end, k + 2));
    const auto [rate, misfit] = local_fit(s, receptance, first, last - first + 1);
    const double turn = 2 * std::numbers::pi;
    if (!(misfit < largest_misfit && rate.real() < 0 &&
          rate.imag() > turn * frequency_hz[first] - std::abs(rate.real()) &&
          rate.imag() < turn * frequency_hz[last] + std::abs(rate.real())))
      continue;
    poles.push_back({rate, VectorXcd::Ones(responses.rows())});
  }
  return poles;
}

namespace {

Index force_row(const Record& record) {
  Index row = -1;
  for (Index i = 0; i < record.samples.rows(); ++i) {
    const Quantity quantity = record.channels[i].quantity;
    if (is_input(quantity) && quantity != Quantity::force)
      throw std::invalid_argument(
          "the record holds the acceleration of the base; frequency responses expect a hammer's force alone");
    if (record.channels[i].quantity == Quantity::force) {
      if (row >= 0)
        throw std::invalid_argument("the record has several channels of force; expected the hammer's alone");
      row = i;
    }
  }
  if (row < 0)
    throw std::invalid_argument(
        "the record has no channel of force; frequency responses need one (--column, --quantity force)");
  return row;
}

void require_all_readings(const Record& record) {
  for (Index k = 0; k < record.size(); ++k)
    if (!record.samples.col(k).allFinite())
      throw std::invalid_argument(
          fmt::format("a reading is missing or clipped at {:.6g} s; frequency responses expect every one "
                      "(a --window without them, or hits that the sensors can follow)",
                      record.time[k]));
}

/// What precedes a hit belongs to its block: a sampled pulse rings ahead of itself.
constexpr Index lead = 8;

struct ForceBlock {
  const Record* record;
  const VectorXd* force;
  Index begin, length;
  HitSampling sampling;
};

/// Sets what noise and sampling leave unknown of the force, and says which hits are too coarse.
void judge_sampling(const std::vector<ForceBlock>& blocks, double interval, HammerResponses& found) {
  std::vector<HitSampling> hits;
  VectorXd squares;
  for (const ForceBlock& block : blocks) {
    hits.push_back(block.sampling);
    found.pulse_s += 1.5 * interval * block.sampling.above_half / static_cast<double>(blocks.size());
    const double noise = block.sampling.noise_n;
    const VectorXd part = block.force->segment(block.begin, block.length);
    Index end = part.size();
    while (end > 1 && part[end - 1] == 0) --end;
    if (squares.size() < end) squares.conservativeResizeLike(VectorXd::Zero(end));
    squares.head(end).array() += noise * noise / static_cast<double>(blocks.size());
  }
  found.force_noise = squares.cwiseSqrt();
  found.unresolved = unresolved_on_average(hits);
  found.masses_lost = unresolved_at_once(hits) > lost_momentum;
  found.coarse = coarse_hits(hits, interval);
}

/// Whether a motion of more than 5 % of what follows precedes a hit. Noise has no memory: motion is what
/// neighbouring samples have in common, beyond four standard deviations of that in noise alone.
bool moves_before(const VectorXd& response, Index begin, Index part) {
  constexpr double least = 0.05, deviations = 4;
  const double mean = response.mean();
  const VectorXd before = response.segment(begin - part, part).array() - mean,
                 after = response.segment(begin + 2 * lead, part).array() - mean;
  const double common = before.head(part - 1).dot(before.tail(part - 1)),
               noise = 0.5 * (before.tail(part - 1) - before.head(part - 1)).squaredNorm();
  return common > std::max(least * least * after.squaredNorm(), deviations * noise / std::sqrt(part));
}

bool met_motion(const ForceBlock& block) {
  const Index part = std::min(block.begin, block.length / 10);
  for (Index row = 0; part >= 16 && row < block.record->samples.rows(); ++row)
    if (row != force_row(*block.record) &&
        moves_before(block.record->samples.row(row).transpose(), block.begin, part))
      return true;
  return false;
}

/// What a hit met goes on through its block, and no force of the block makes it. Where no hit met rest, all
/// stay.
void leave_out_moving(std::vector<ForceBlock>& blocks, HammerResponses& found) {
  const auto moving = std::stable_partition(blocks.begin(), blocks.end(), std::not_fn(met_motion));
  if (moving == blocks.end()) return;
  const std::string met =
      fmt::format("{} of {} hits met a structure that still moved, by more than 5 % of what followed: ",
                  blocks.end() - moving, blocks.size());
  if (moving == blocks.begin()) {
    found.objections.emplace_back(
        "met_in_motion", met +
                             "the modal masses are off by as much, frequencies and damping ratios by more "
                             "than their standard deviations. Expected hits from rest.");
    return;
  }
  found.remarks.push_back(met + "excluded.");
  blocks.erase(moving, blocks.end());
}

VectorXcd spectrum(const VectorXd& windowed) {
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  const std::vector<double> in(windowed.begin(), windowed.end());
  std::vector<std::complex<double>> out;
  transform.fwd(out, in);
  return Eigen::Map<const VectorXcd>(out.data(), static_cast<Index>(out.size()));
}

}  // namespace

std::vector<Hit> find_hits(const VectorXd& force, double interval) {
  const double baseline = median(force);
  const Onsets onsets = find_onsets(force, interval);
  std::vector<Hit> hits;
  for (std::size_t k = 0; k < onsets.samples.size(); ++k) {
    const Index onset = onsets.samples[k];
    Index stop = k + 1 < onsets.samples.size() ? onsets.samples[k + 1] : force.size();
    stop = std::min(stop, onset + std::max<Index>(8, static_cast<Index>(0.1 / interval)));
    const VectorXd part = (force.segment(onset, stop - onset).array() - baseline).abs();
    Hit hit{onset, stop, VectorXd::Zero(force.size()), 0, part.maxCoeff(), {}};
    Index last = part.size() - 1;
    while (last > 0 && part[last] < 0.05 * hit.largest) --last;
    const Index taper = std::max<Index>(lead, last / 4);
    const Index begin = std::max<Index>(0, onset - lead);
    hit.end = std::min(stop, onset + last + 1 + taper);
    for (Index i = begin; i < hit.end; ++i) {
      const double past = static_cast<double>(i - onset - last) / static_cast<double>(taper + 1);
      const double window = past <= 0 ? 1 : 0.5 + 0.5 * std::cos(std::numbers::pi * past);
      hit.force[i] = window * (force[i] - baseline);
    }
    hit.impulse = interval * hit.force.sum();
    bool above = false;
    for (Index i = 0; i <= last; ++i) {
      const bool now = part[i] > 0.1 * hit.largest;
      if (now && !above) hit.pulses_s.push_back(static_cast<double>(i) * interval);
      if (now && part[i] > part[static_cast<Index>(std::lround(hit.pulses_s.back() / interval))])
        hit.pulses_s.back() = static_cast<double>(i) * interval;
      above = now;
    }
    hits.push_back(std::move(hit));
  }
  if (hits.empty()) throw std::invalid_argument("the force shows no hit");
  return hits;
}

HammerResponses hammer_responses(const std::vector<Record>& records, double window_end) {
  if (!(window_end > 0 && window_end <= 1))
    throw std::invalid_argument(
        fmt::format("window_end is {:g}; expected more than 0 and at most 1", window_end));
  HammerResponses found;
  std::vector<std::vector<Hit>> hits;
  std::vector<ForceBlock> blocks;
  const double interval = records.front().interval();
  for (const Record& record : records) {
    require_all_readings(record);
    if (std::abs(record.interval() / interval - 1) > 1e-5)
      throw std::invalid_argument(fmt::format("sampling intervals of {:.6g} and {:.6g} s; expected the same",
                                              interval, record.interval()));
    hits.push_back(find_hits(record.samples.row(force_row(record)).transpose(), interval));
  }
  Index longest = 0;
  for (std::size_t r = 0; r < records.size(); ++r)
    for (std::size_t k = 0; k < hits[r].size(); ++k) {
      const Hit& hit = hits[r][k];
      const Index begin = std::max<Index>(0, hit.onset - lead);
      const Index stop =
          k + 1 < hits[r].size() ? std::max<Index>(0, hits[r][k + 1].onset - lead) : records[r].size();
      blocks.push_back({&records[r], &hit.force, begin, stop - begin,
                        hit_sampling(records[r].samples.row(force_row(records[r])).transpose(), hit)});
      longest = std::max(longest, stop - begin);
    }
  for (const std::vector<Hit>& of_record : hits)
    for (const Hit& hit : of_record)
      if (hit.pulses_s.size() > 1)
        found.objections.emplace_back(
            "damped_by_hammer",
            fmt::format(
                "The hit of {:.3g} N rebounded, {} pulses within {:.3g} ms: all are in its force, but what "
                "the "
                "hammer touches in between is no free structure. No mass from this hit is to be trusted.",
                hit.largest, hit.pulses_s.size(), 1000 * (hit.pulses_s.back() - hit.pulses_s.front())));
  const std::size_t all = blocks.size();
  std::erase_if(blocks, [&](const ForceBlock& block) { return 3 * block.length < longest; });
  if (blocks.size() < all)
    found.remarks.push_back(fmt::format(
        "{} hits with less than a third of the longest one's record were excluded.", all - blocks.size()));
  leave_out_moving(blocks, found);
  Index length = longest;
  for (const ForceBlock& block : blocks) length = std::min(length, block.length);
  if (length < 64)
    throw std::invalid_argument(fmt::format("{} samples behind a hit; expected 64 at least", length));
  length = fast_length_within(length);

  judge_sampling(blocks, interval, found);
  found.interval = interval;
  found.averages = static_cast<int>(blocks.size());
  found.duration = interval * static_cast<double>(length);
  found.window_rate = -std::log(window_end) / found.duration;
  const VectorXd window =
      (-found.window_rate * interval * VectorXd::LinSpaced(length, 0, static_cast<double>(length - 1)))
          .array()
          .exp();
  const Index lines = length / 2 + 1, outputs = records.front().samples.rows() - 1;
  if (outputs < 1) throw std::invalid_argument("the record holds a force only; expected a response as well");
  VectorXd ff = VectorXd::Zero(lines);
  found.force_mean = VectorXcd::Zero(lines);
  MatrixXd yy = MatrixXd::Zero(outputs, lines);
  MatrixXcd yf = MatrixXcd::Zero(outputs, lines);
  for (const ForceBlock& block : blocks) {
    const VectorXcd f = spectrum(window.cwiseProduct(block.force->segment(block.begin, length)));
    ff += f.head(lines).cwiseAbs2();
    found.force_mean += f.head(lines) / static_cast<double>(blocks.size());
    const Index force = force_row(*block.record);
    for (Index i = 0, row = 0; row < block.record->samples.rows(); ++row) {
      if (row == force) continue;
      VectorXd y = block.record->samples.row(row).segment(block.begin, length).transpose();
      y.array() -= block.record->samples.row(row).mean();
      const VectorXcd transformed = spectrum(window.cwiseProduct(y));
      yy.row(i) += transformed.head(lines).cwiseAbs2().transpose();
      yf.row(i) += transformed.head(lines).cwiseProduct(f.head(lines).conjugate()).transpose();
      ++i;
    }
  }
  const double floor = 1e-12 * ff.maxCoeff();
  found.frequency_hz = VectorXd::LinSpaced(lines, 0, static_cast<double>(lines - 1)) / found.duration;
  found.h1.resize(outputs, lines);
  found.h2.resize(outputs, lines);
  found.coherence.resize(outputs, lines);
  for (Index i = 0; i < outputs; ++i)
    for (Index k = 0; k < lines; ++k) {
      const double power = std::norm(yf(i, k));
      found.h1(i, k) = yf(i, k) / std::max(ff[k], floor);
      found.h2(i, k) = power > 0 ? yy(i, k) / std::conj(yf(i, k)) : found.h1(i, k);
      found.coherence(i, k) = power / std::max(ff[k] * yy(i, k), 1e-300);
    }
  found.force_spectrum = interval * (ff / static_cast<double>(found.averages)).cwiseSqrt();
  return found;
}

}  // namespace beamid::experiments
