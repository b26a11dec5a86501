#include "experiments/sweep/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <thread>
#include <tuple>

namespace beamid::experiments {
namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

std::vector<CaseBlock> blocks_of(const SweepPlan& plan, const std::vector<std::size_t>& numbers) {
  const std::size_t most = plan.once ? 16 : 1;
  std::vector<CaseBlock> blocks;
  for (const std::size_t number : numbers) {
    const bool joins = !blocks.empty() && blocks.back().size() < most &&
                       plan.sample_of(blocks.back().front()) == plan.sample_of(number);
    if (!joins) blocks.emplace_back();
    blocks.back().push_back(number);
  }
  return blocks;
}

bool CaseQueue::next(CaseBlock& block) {
  const std::lock_guard lock(mutex_);
  if (given_ >= blocks_.size()) return false;
  block = blocks_[given_++];
  return true;
}

void CaseQueue::stop() {
  const std::lock_guard lock(mutex_);
  given_ = blocks_.size();
}

std::size_t CaseQueue::cases() const {
  std::size_t count = 0;
  for (const CaseBlock& block : blocks_) count += block.size();
  return count;
}

std::string duration_text(double seconds) {
  const auto whole = std::lround(seconds);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

CaseProgress::CaseProgress(std::size_t before, std::size_t all, const Progress& progress)
    : before_(before), all_(all), progress_(progress), started_(now()) {}

void CaseProgress::count(std::size_t cases) {
  done_ += cases;
  const double time = now();
  if (time - shown_ < 0.2) return;
  shown_ = time;
  const double rate = static_cast<double>(done_) / std::max(time - started_, 1e-9);
  const std::size_t left = all_ - before_ - done_;
  progress_(fmt::format("{} of {} cases, {:.3g} per second, {} left", before_ + done_, all_, rate,
                        duration_text(static_cast<double>(left) / rate)));
}

void run_cases(CaseQueue& queue, int threads, const CaseRunner& run, const CaseSink& sink) {
  std::mutex one_at_a_time;
  std::exception_ptr trouble;
  const auto work = [&] {
    try {
      for (CaseBlock block; queue.next(block);) {
        std::vector<SweepRow> rows = run(block);
        const std::lock_guard lock(one_at_a_time);
        if (trouble) return;
        sink(std::move(rows));
      }
    } catch (...) {
      queue.stop();
      const std::lock_guard lock(one_at_a_time);
      if (!trouble) trouble = std::current_exception();
    }
  };
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  if (trouble) std::rethrow_exception(trouble);
}

void sort_rows(std::vector<SweepRow>& rows) {
  std::sort(rows.begin(), rows.end(), [](const SweepRow& a, const SweepRow& b) {
    return std::tie(a.number, a.row) < std::tie(b.number, b.row);
  });
}

}  // namespace beamid::experiments
