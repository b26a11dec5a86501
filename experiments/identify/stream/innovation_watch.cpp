#include "experiments/identify/stream/innovation_watch.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "experiments/text/json_file.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

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

}  // namespace beamid::experiments
