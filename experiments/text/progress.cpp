#include "experiments/text/progress.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace beamid::experiments {
namespace {

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

std::string duration_text(double seconds) {
  const auto whole = std::lround(seconds);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

Countdown::Countdown(const Progress& progress, std::size_t all, std::string unit, std::size_t before)
    : progress_(progress), all_(all), before_(before), unit_(std::move(unit)), started_(seconds_now()) {}

void Countdown::begin(const std::string& what) {
  const std::lock_guard lock(mutex_);
  what_ = what + ": ";
  show();
}

void Countdown::count(std::size_t more) {
  constexpr double at_most_every = 0.2;  // [s]
  const std::lock_guard lock(mutex_);
  done_ += more;
  if (seconds_now() - shown_ >= at_most_every) show();
}

void Countdown::show() {
  shown_ = seconds_now();
  if (all_ == 1) return progress_(what_.substr(0, what_.rfind(": ")));  // its name says it all
  std::string text = fmt::format("{}{} of {} {}", what_, before_ + done_, all_, unit_);
  if (done_ > 0) {
    const double rate = static_cast<double>(done_) / std::max(shown_ - started_, 1e-9);
    const std::size_t left = all_ - std::min(all_, before_ + done_);
    text += fmt::format(", {:.3g} per second, {} remaining", rate,
                        duration_text(static_cast<double>(left) / rate));
  }
  progress_(text);
}

}  // namespace beamid::experiments
