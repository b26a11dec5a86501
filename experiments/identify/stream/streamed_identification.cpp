#include "experiments/identify/stream/streamed_identification.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <boost/math/distributions/chi_squared.hpp>

#include "experiments/identify/engine/identified_parameters.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

// A mean m of variance P is predicted with P + R and moves by P / (P + R) of what it misses. An output's
// first reading is its mean's, and says nothing for either side: then neither counts.
void MotionEvidence::take_in(const VectorXd& output, const VectorXd& deviations,
                             const filters::Correction& correction, double mean_square) {
  if (seen_) return;
  if (mean_.size() == 0) mean_ = variance_ = VectorXd::Zero(output.size());
  // Of larger noise squares are divided by mean_square; what that does to determinants is the same for both.
  const double taken_back = mean_square > 1.0 ? 0.5 - 0.5 / mean_square : 0.0;
  double gain = correction.log_likelihood + taken_back * correction.normalised_square;
  bool known = correction.innovation.size() > 0;
  for (Index i = 0; i < output.size(); ++i) {
    if (!std::isfinite(output[i])) continue;
    const double noise = deviations[i] * deviations[i], error = output[i] - mean_[i];
    if (variance_[i] == 0.0) {
      known = false;
      mean_[i] = output[i], variance_[i] = noise;
      continue;
    }
    const double predicted = variance_[i] + noise, square = error * error / predicted;
    gain += 0.5 * (square + std::log(2.0 * std::numbers::pi * predicted)) - taken_back * square;
    mean_[i] += variance_[i] / predicted * error;
    variance_[i] *= noise / predicted;
  }
  if (known && std::isfinite(gain)) evidence_ += gain;
  seen_ = evidence_ > -std::log(unlikely);
}

nlohmann::ordered_json MotionEvidence::save() const {
  return {{"seen", seen_},
          {"evidence", evidence_},
          {"mean", std::vector<double>(mean_.begin(), mean_.end())},
          {"variance", std::vector<double>(variance_.begin(), variance_.end())}};
}

void MotionEvidence::resume(const nlohmann::json& saved, Index outputs) {
  MotionEvidence read;
  read.seen_ = saved.at("seen").get<bool>();
  read.evidence_ = saved.at("evidence").get<double>();
  const auto vector = [&](const char* key) {
    const auto values = saved.at(key).get<std::vector<double>>();
    if (!values.empty() && static_cast<Index>(values.size()) != outputs)
      throw std::invalid_argument(std::string("motion.") + key + " is not one number for every output");
    return VectorXd(Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size())));
  };
  read.mean_ = vector("mean");
  read.variance_ = vector("variance");
  if (read.mean_.size() != read.variance_.size() || (read.variance_.array() < 0.0).any())
    throw std::invalid_argument("motion.variance is none of motion.mean");
  *this = read;
}

namespace {

constexpr double largest_square = 1e300;  // square: a sum of a window stays a number

// What chi-square of so many degrees exceeds with this probability.
double limit(std::map<Index, double>& known, Index degrees, double probability) {
  double& value = known[degrees];
  if (value == 0.0)
    value = quantile(complement(boost::math::chi_squared(static_cast<double>(degrees)), probability));
  return value;
}

}  // namespace

InnovationWatch::Verdict InnovationWatch::judge(double normalised_square, Index outputs) {
  if (outputs == 0) return Verdict::keep;
  const double square =
      normalised_square < largest_square ? normalised_square : largest_square;  // also of a NaN
  if (settled_ && square > limit(gates_, outputs, outlying)) {
    ++left_out_;
    return ++in_a_row_ < several ? Verdict::leave_out : begin_anew(Verdict::jumped);
  }
  in_a_row_ = 0;
  squares_.emplace_back(square, outputs);
  degrees_ += outputs;
  for (; degrees_ - squares_.front().second >= window; squares_.pop_front())
    degrees_ -= squares_.front().second;
  sum_ = std::min(sum_ + square, largest_square);
  since_ += outputs;
  if (!settled_) unsettled_ += outputs;
  if (degrees_ < window) return Verdict::keep;

  if (!in_bounds()) {
    if (settled_) return begin_anew(Verdict::left);
    was_out_ = true;
    in_bounds_ = 0;
    if (since_ < allowed_) return Verdict::keep;
    allowed_ = std::min(2 * allowed_, most_patience);
    return begin_anew(Verdict::gave_up);
  }
  if (was_out_) return begin_anew(Verdict::returned);
  in_bounds_ += outputs;
  if (!settled_ && in_bounds_ + window >= settling) {
    settled_ = true;
    allowed_ = patience;
    unsettled_ = 0;
  }
  return Verdict::keep;
}

InnovationWatch::Verdict InnovationWatch::begin_anew(Verdict why) {
  at_verdict_ = mean_square();
  squares_.clear();
  degrees_ = since_ = in_bounds_ = in_a_row_ = 0;
  sum_ = 0.0;
  settled_ = was_out_ = false;
  ++starts_;
  return why;
}

bool InnovationWatch::begin_anew_after_failure() {
  if (settled_ || degrees_ < window || in_bounds()) return false;
  begin_anew(Verdict::gave_up);
  return true;
}

bool InnovationWatch::in_bounds() const {
  return mean_square() * static_cast<double>(degrees_) <= limit(bounds_, degrees_, unlikely);
}

double InnovationWatch::mean_square() const {
  if (degrees_ == 0) return std::numeric_limits<double>::quiet_NaN();
  const double sum = std::accumulate(squares_.begin(), squares_.end(), 0.0,
                                     [](double all, const auto& one) { return all + one.first; });
  return std::min(sum, largest_square) / static_cast<double>(degrees_);
}

double InnovationWatch::largest_mean_square() const {
  if (degrees_ == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::max(mean_square(), sum_ / static_cast<double>(since_));
}

nlohmann::ordered_json InnovationWatch::save() const {
  auto window_squares = nlohmann::ordered_json::array();
  for (const auto& [square, outputs] : squares_) window_squares.push_back({square, outputs});
  return {{"settled", settled_}, {"window", window_squares}, {"sum", sum_},
          {"outputs", since_},   {"in_bounds", in_bounds_},  {"unsettled", unsettled_},
          {"allowed", allowed_}, {"in_a_row", in_a_row_},    {"left_out", left_out_},
          {"starts", starts_},   {"was_out", was_out_}};
}

void InnovationWatch::resume(const nlohmann::json& saved) {
  constexpr Index most_in_window = 1'000'000;
  const auto count = [&](const char* key) -> Index {
    return whole_number(saved.at(key), std::string("health.") + key, 0, most_outputs);
  };
  InnovationWatch read;
  read.settled_ = saved.at("settled").get<bool>();
  read.was_out_ = saved.at("was_out").get<bool>();
  read.sum_ = saved.at("sum").get<double>();
  read.since_ = count("outputs");
  read.in_bounds_ = count("in_bounds");
  read.unsettled_ = count("unsettled");
  read.allowed_ = std::clamp(count("allowed"), patience, most_patience);
  read.in_a_row_ = count("in_a_row");
  read.left_out_ = count("left_out");
  read.starts_ = count("starts");
  for (const auto& one : saved.at("window")) {
    read.squares_.emplace_back(one.at(0).get<double>(),
                               whole_number(one.at(1), "outputs of health.window", 1, most_in_window));
    const auto& [square, outputs] = read.squares_.back();
    if (!(square >= 0.0)) throw std::invalid_argument("health.window holds what is no square");
    read.degrees_ += outputs;
  }
  if (read.degrees_ > read.since_ || !(read.sum_ >= 0.0))
    throw std::invalid_argument("health.window has more outputs than the filter has seen");
  *this = read;
}

namespace {

constexpr Index outliers_reported = 5;  // one by one

}  // namespace

StreamedIdentification::StreamedIdentification(const Experiment& experiment, const Record& earlier)
    : names_(earlier.channel_names()),
      prepared_(stream_start(experiment, earlier)),
      choice_(experiment.filter),
      interval_(earlier.interval()) {
  const auto& settings = prepared_.settings;
  filter_ = at_place(choice_.place, [&] {
    return filters::filter_registry().make(
        settings.filter, settings.filter_options,
        filters::discretise(prepared_.model.motion, interval_, settings.discretisation,
                            {{}, settings.output_noise}));
  });
  running_ = std::make_unique<filters::RunningFilter>(*filter_, settings.on_failure,
                                                      measurements(earlier).time_resolution);
  running_->start(settings.initial, settings.start);
  for (const Objection& one : prepared_.objections)
    news_.push_back("The earlier record, identified alike: " + one.text);
}

bool StreamedIdentification::take_in(const filters::Sample& sample) {
  const bool moved = running_->move_to(sample.time);
  const filters::Gaussian predicted = moved ? running_->estimate() : filters::Gaussian{};
  const bool goes_on = moved && running_->correct(sample);
  list_failures();
  if (!goes_on) {
    if (good_.step == 0 || !watch_.begin_anew_after_failure()) return false;
    filters::SavedRun again = good_;
    again.estimate = first_estimate(at_first());
    again.alarm = {};
    running_->resume(again);
    reported_ = 0;
    begin_anew(InnovationWatch::Verdict::gave_up);
    good_ = running_->save();
    return true;
  }
  heed(sample, predicted);
  good_ = running_->save();
  return true;
}

// The divergence alarm of a run is left to InnovationWatch, which acts on it.
void StreamedIdentification::list_failures() {
  const auto& events = running_->events();
  for (; reported_ < events.size(); ++reported_)
    if (!events[reported_].reason.starts_with("the innovations diverge"))
      news_.push_back(failure_sentences({events[reported_]}));
}

void StreamedIdentification::heed(const filters::Sample& sample, const filters::Gaussian& predicted) {
  using Watched = InnovationWatch::Verdict;
  const filters::Correction& correction = running_->correction();
  const Index outputs = correction.innovation.size();
  const bool before = watch_.settled() && motion_.seen();
  const Watched verdict = watch_.judge(correction.normalised_square, outputs);
  if (verdict == Watched::keep) {
    const VectorXd deviations = prepared_.settings.output_noise.diagonal().cwiseSqrt();
    motion_.take_in(sample.output, deviations, correction, watch_.mean_square());
  }
  saw_motion_ = saw_motion_ || motion_.seen();
  status_ = !watch_.settled() ? Status::settling : motion_.seen() ? Status::settled : Status::undetermined;
  if (verdict == Watched::leave_out) {
    filter_->reset(predicted);
    status_ = Status::left_out;
    if (watch_.left_out() <= outliers_reported)
      news_.push_back(
          fmt::format("Sample {} at {:.6g} s is omitted: its normalised innovation square is {:.3g}"
                      "; expected {}.{}",
                      running_->step(), running_->time(), correction.normalised_square, outputs,
                      watch_.left_out() < outliers_reported ? "" : " Others are counted only."));
  } else if (verdict != Watched::keep) {
    begin_anew(verdict);
  } else if (status_ == Status::settled && outputs > 0) {
    if (!before && watch_.starts() > 0)
      news_.push_back(fmt::format("Settled at {:.6g} s.", running_->time()));
    remembered_ += outputs;
    if (before && remembered_ < InnovationWatch::window) return;
    older_ = newer_;
    newer_ = known_now();
    remembered_ = 0;
  } else if (status_ == Status::undetermined && (at_rest_ += outputs) >= InnovationWatch::most_patience) {
    filter_->reset(first_estimate(at_first()));  // what noise has taught it
    motion_.begin_anew();
    at_rest_ = 0;
  }
}

void StreamedIdentification::begin_anew(InnovationWatch::Verdict why) {
  using Watched = InnovationWatch::Verdict;
  status_ = Status::begun_anew;
  std::string said;
  const double time = running_->time(), square = watch_.square_at_verdict();
  if (why == Watched::jumped)
    said = fmt::format("{} samples in a row up to {:.6g} s do not continue the motion: a hit or a release.",
                       InnovationWatch::several, time);
  else if (why == Watched::returned)
    said = fmt::format(
        "At {:.6g} s the innovations agree with the filter; what it learned before is dropped.", time);
  else
    said = fmt::format(
        "At {:.6g} s the innovations do not agree with the filter: their mean normalised square over {} "
        "outputs is {:.3g}; expected 1. Motion that the model does not have, more noise than in the earlier "
        "record, or another structure.",
        time, InnovationWatch::window, square);
  if (why == Watched::left) newer_ = older_;
  Known start = at_first();
  if (newer_ && watch_.unsettled() <= forget_after) {
    start = *newer_;
    said += " The motion begins anew, with the unknowns as they were known.";
  } else {
    const Known now = newer_.value_or(motion_.seen() ? known_now() : start);
    const VectorXd far = (now.mean - start.mean).cwiseAbs2() - 9.0 * start.covariance.diagonal();
    if (why != Watched::gave_up && (far.array() <= 0.0).all()) start.mean = now.mean;
    newer_.reset();
    older_.reset();
    motion_.begin_anew();
    at_rest_ = 0;
    said += " The filter begins anew, the unknowns as uncertain as at first.";
  }
  filter_->reset(first_estimate(start));
  news_.push_back(said);
}

StreamedIdentification::Known StreamedIdentification::known_now() const {
  const filters::Gaussian estimate = filter_->marginal(prepared_.model.unknown_places);
  return {estimate.mean, estimate.marginal(0, estimate.mean.size())};
}

StreamedIdentification::Known StreamedIdentification::at_first() const {
  const filters::Gaussian& estimate = prepared_.settings.initial;
  const auto& places = prepared_.model.unknown_places;
  return {estimate.mean(places), estimate.covariance(places, places)};
}

// About the sample just taken in: the motion as unknown as at first.
filters::Gaussian StreamedIdentification::first_estimate(const Known& unknowns) const {
  filters::Gaussian estimate = prepared_.settings.initial;
  const auto& places = prepared_.model.unknown_places;
  estimate.mean(places) = unknowns.mean;
  estimate.covariance(places, places) = unknowns.covariance;
  return estimate;
}

std::vector<std::string> StreamedIdentification::news() {
  return std::exchange(news_, {});
}

double StreamedIdentification::interval_factor() const {
  const double mean = watch_.largest_mean_square();
  return std::max(1.0, prepared_.interval_factor) * std::sqrt(std::max(1.0, std::isnan(mean) ? 1.0 : mean));
}

const char* word(StreamedIdentification::Status status) {
  using Status = StreamedIdentification::Status;
  switch (status) {
    case Status::settling:
      return "settling";
    case Status::settled:
      return "settled";
    case Status::undetermined:
      return "undetermined";
    case Status::left_out:
      return "left_out";
    default:
      return "begun_anew";
  }
}

std::vector<StreamedIdentification::Shown> StreamedIdentification::shown() const {
  const bool at_rest = watch_.settled() && !motion_.seen();
  const filters::Gaussian estimate = at_rest ? prepared_.settings.initial : running_->estimate();
  std::vector<Shown> all;
  for (const Estimate& one : estimates(prepared_.model, estimate))
    all.push_back({one.name, one.unit, one.value, one.deviation});
  if (!is_oscillator(prepared_.model)) return all;
  const Identification found = identification_at(prepared_.model, estimate);
  all.push_back({"frequency", "Hz", found.found.frequency_hz(), found.frequency_deviation_hz});
  all.push_back({"damping_ratio", "", found.found.damping_ratio(), found.damping_ratio_deviation});
  return all;
}

std::string stream_header(const StreamedIdentification& stream) {
  std::string header = "time_s";
  for (const auto& one : stream.shown())
    header += "," + column_key(one.name, one.unit) + "," + column_key(one.name + "_deviation", one.unit);
  return header + ",mean_normalised_square,status\n";
}

std::string stream_row(double time, const StreamedIdentification& stream) {
  const double widen = stream.interval_factor();
  std::string row = csv_field(time);
  for (const auto& one : stream.shown())
    row += "," + csv_field(one.value) + "," + csv_field(widen * one.deviation);
  return row + "," + csv_field(stream.watch().mean_square()) + "," + word(stream.status()) + "\n";
}

}  // namespace beamid::experiments
