#include "experiments/sweep/sweep.hpp"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <optional>
#include <thread>
#include <tuple>

namespace beamid::experiments {
namespace {

/// Threads beside this one. Where the system refuses one, half of those that it allowed go at once, and all
/// that have no core of their own: the work needs the memory that they would take. None works before that is
/// decided.
class Helpers {
 public:
  Helpers(std::size_t wanted, const std::function<void()>& work) {
    threads_.reserve(wanted);
    std::size_t needed = wanted;
    try {
      while (threads_.size() < wanted)
        threads_.emplace_back([this, work, number = threads_.size()] {
          if (is_needed(number)) work();
        });
    } catch (const std::exception&) {  // no thread, or no memory for one
      const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
      needed = std::min(threads_.size() / 2, cores - 1);
    }
    decide(needed);
    for (; threads_.size() > needed; threads_.pop_back()) threads_.back().join();
    decide(needed, true);
  }
  ~Helpers() { join(); }
  Helpers(const Helpers&) = delete;
  Helpers& operator=(const Helpers&) = delete;

  void join() {
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

 private:
  void decide(std::size_t needed, bool go = false) {
    const std::lock_guard lock(mutex_);
    needed_ = needed;
    go_ = go;
    decided_.notify_all();
  }

  bool is_needed(std::size_t number) {
    std::unique_lock lock(mutex_);
    decided_.wait(lock, [&] { return go_ || (needed_ && number >= *needed_); });
    return number < *needed_;
  }

  std::mutex mutex_;
  std::condition_variable decided_;
  std::optional<std::size_t> needed_;
  bool go_ = false;
  std::vector<std::thread> threads_;
};

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

std::size_t CaseQueue::blocks() const {
  return blocks_.size();
}

std::size_t CaseQueue::cases() const {
  std::size_t count = 0;
  for (const CaseBlock& block : blocks_) count += block.size();
  return count;
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
  const std::size_t most = std::max<std::size_t>(queue.blocks(), 1);
  Helpers helpers(std::min(static_cast<std::size_t>(threads), most) - 1, work);
  work();
  helpers.join();
  if (trouble) std::rethrow_exception(trouble);
}

void sort_rows(std::vector<SweepRow>& rows) {
  std::sort(rows.begin(), rows.end(), [](const SweepRow& a, const SweepRow& b) {
    return std::tie(a.number, a.row) < std::tie(b.number, b.row);
  });
}

}  // namespace beamid::experiments
