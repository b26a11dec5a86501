#include "apps/python/module.hpp"

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <exception>
#include <iostream>
#include <mutex>
#include <sstream>
#include <thread>

#include "apps/command.hpp"
#include "apps/command_parts.hpp"
#include "experiments/results/results.hpp"
#include "filters/stop_request.hpp"

namespace beamid::python {
namespace {

class Collector final : public apps::Receiver {
 public:
  Collector(Outcome& outcome, const std::atomic<bool>& stop) : outcome_(outcome), stop_(stop) {}
  void take(experiments::Results results) override { outcome_.results = std::move(results); }
  void progress(const std::string&) override {
    if (stop_) throw filters::Stopped();
  }

 private:
  Outcome& outcome_;
  const std::atomic<bool>& stop_;
};

/// What is printed to standard output while it lives; one at a time.
class Printed {
 public:
  Printed() : lock_(one_at_a_time()), before_(std::cout.rdbuf(text_.rdbuf())) {}
  ~Printed() { std::cout.rdbuf(before_); }
  Printed(const Printed&) = delete;
  Printed& operator=(const Printed&) = delete;
  std::string text() const { return text_.str(); }

 private:
  static std::mutex& one_at_a_time() {
    static std::mutex mutex;
    return mutex;
  }
  std::lock_guard<std::mutex> lock_;
  std::ostringstream text_;
  std::streambuf* before_;
};

bool has_results(const apps::Command& command) {
  for (const apps::OptionGroup& group : command.options)
    for (const apps::Option& option : group.options)
      if (option.name == "json") return true;
  return false;
}

void run_here(const std::string& name, const std::vector<std::string>& words, const std::atomic<bool>& stop,
              Outcome& outcome) {
  std::string reached;
  try {
    const apps::Command& command = apps::find_command(name);
    reached = name;
    Collector collector(outcome, stop);
    if (has_results(command)) {
      outcome.code = apps::run_command(name, words, collector);
    } else {
      const Printed printed;
      outcome.code = apps::run_command(name, words, collector);
      outcome.printed = printed.text();
    }
  } catch (const filters::Stopped&) {
  } catch (...) {
    outcome.refusal = apps::described(std::current_exception(), reached);
    outcome.code = outcome.refusal->code;
  }
}

}  // namespace

Outcome run(const std::string& command, const std::vector<std::string>& words) {
  Outcome outcome;
  std::atomic<bool> stop = false;
  bool done = false;
  std::mutex mutex;
  std::condition_variable ended;
  std::optional<pybind11::error_already_set> signal;
  {
    const pybind11::gil_scoped_release release;
    std::thread worker([&] {
      const filters::StopRequest heeded(stop);
      run_here(command, words, stop, outcome);
      const std::lock_guard lock(mutex);
      done = true;
      ended.notify_one();
    });
    std::unique_lock lock(mutex);
    constexpr auto between_looks = std::chrono::milliseconds(50);
    while (!ended.wait_for(lock, between_looks, [&] { return done; })) {
      if (stop) continue;
      lock.unlock();  // the lock of Python is never waited for while holding another
      {
        const pybind11::gil_scoped_acquire acquire;
        if (PyErr_CheckSignals() != 0) signal.emplace(), stop = true;
      }
      lock.lock();
    }
    lock.unlock();
    worker.join();
  }
  if (signal) throw pybind11::error_already_set(*signal);
  return outcome;
}

int run_main(std::vector<std::string> words) {
  std::signal(SIGINT, SIG_DFL);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  return apps::run_command_line(static_cast<int>(pointers.size()), pointers.data());
}

std::string Outcome::json() const {
  std::ostringstream text;
  if (results) experiments::print_json(text, *results);
  return text.str();
}

std::string Outcome::report() const {
  std::ostringstream text;
  if (results) experiments::print(text, *results);
  return results ? text.str() : printed;
}

void Outcome::write(const std::string& folder, bool force, const std::string& command_line,
                    const std::string& experiment_file) {
  if (!results) throw std::invalid_argument("a command that only prints has no files to write");
  results->command_line = command_line;
  results->experiment_file = experiment_file;
  experiments::ResultDirectory directory(folder, force);
  experiments::write(*results, directory);
  directory.commit();
}

}  // namespace beamid::python
