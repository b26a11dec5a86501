#include "experiments/record/read_apart.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): more of POSIX than <csignal> promises
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "experiments/text/fields.hpp"
#include "experiments/text/memory_need.hpp"

namespace beamid::experiments {
namespace {

// The pipe between a process and the child that reads a file for it.

/// The child's end: numbers and texts as they lie in memory. The child ends where nobody listens.
class PipeSender {
 public:
  explicit PipeSender(int descriptor) : descriptor_(descriptor) {}

  void bytes(const void* from, std::size_t count) const;
  void text(const std::string& text) const;
  template <class Number>
  void number(Number value) const {
    bytes(&value, sizeof value);
  }

 private:
  int descriptor_;
};

/// The parent's end, which it closes. Each of its functions is false where nothing more comes.
class PipeReceiver {
 public:
  PipeReceiver(int descriptor, std::chrono::steady_clock::time_point deadline)
      : descriptor_(descriptor), deadline_(deadline) {}
  ~PipeReceiver();
  PipeReceiver(const PipeReceiver&) = delete;
  PipeReceiver& operator=(const PipeReceiver&) = delete;

  bool bytes(void* to, std::size_t count);
  bool text(std::string& text, std::size_t longest = std::size_t{1} << 20);
  template <class Number>
  bool number(Number& value) {
    return bytes(&value, sizeof value);
  }
  bool late() const { return late_; }  ///< the deadline has passed

 private:
  int descriptor_;
  std::chrono::steady_clock::time_point deadline_;
  bool late_ = false;
};

void PipeSender::bytes(const void* from, std::size_t count) const {
  for (const char* at = static_cast<const char*>(from); count > 0;) {
    const ssize_t written = ::write(descriptor_, at, count);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) _exit(1);
    at += written, count -= static_cast<std::size_t>(written);
  }
}

void PipeSender::text(const std::string& text) const {
  number(text.size());
  bytes(text.data(), text.size());
}

PipeReceiver::~PipeReceiver() {
  close(descriptor_);
}

bool PipeReceiver::bytes(void* to, std::size_t count) {
  using std::chrono::milliseconds, std::chrono::steady_clock;
  constexpr long long longest = 3'600'000;  // [ms] that are waited at once
  for (char* at = static_cast<char*>(to); count > 0;) {
    const long long left = std::chrono::ceil<milliseconds>(deadline_ - steady_clock::now()).count();
    late_ = left <= 0;
    if (late_) return false;
    pollfd watched{descriptor_, POLLIN, 0};
    if (poll(&watched, 1, static_cast<int>(std::min(left, longest))) <= 0) continue;
    const ssize_t got = ::read(descriptor_, at, count);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got, count -= static_cast<std::size_t>(got);
  }
  return true;
}

bool PipeReceiver::text(std::string& text, std::size_t longest) {
  std::size_t size = 0;
  if (!number(size) || size > longest) return false;
  text.resize(size);
  return bytes(text.data(), size);
}

using SteadyClock = std::chrono::steady_clock;

/// How the child ended its work; the first byte it sends.
enum class ApartOutcome : char { found = 'f', refused = 'r', no_memory = 'm' };

std::size_t memory_now() {
  std::ifstream stream("/proc/self/statm");
  std::size_t pages = 0;
  stream >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void limit(__rlimit_resource resource, std::size_t soft, std::size_t hard) {
  rlimit now{};
  if (getrlimit(resource, &now) != 0) return;
  now.rlim_cur = std::min<rlim_t>(soft, now.rlim_max);
  now.rlim_max = std::min<rlim_t>(hard, now.rlim_max);
  setrlimit(resource, &now);
}

/// @param answer reads the file, then sends that it was found and what.
[[noreturn]] void work(int descriptor, const ReadingLimits& limits,
                       const std::function<void(const PipeSender&)>& answer) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGSEGV, SIGBUS, SIGABRT, SIGXCPU})
    signal(number, SIG_DFL);
  if (const int nowhere = open("/dev/null", O_RDWR); nowhere >= 0)
    for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, standard);
  const auto seconds = static_cast<std::size_t>(std::ceil(limits.seconds));
  const std::size_t memory = memory_now() + limits.bytes;
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_CPU, seconds, seconds + 1);
  limit(RLIMIT_AS, memory, memory);
  const PipeSender out(descriptor);
  try {
    answer(out);
  } catch (const std::bad_alloc&) {
    out.number(ApartOutcome::no_memory);
  } catch (const std::exception& error) {
    out.number(ApartOutcome::refused);
    out.text(error.what());
  }
  _exit(0);
}

void send(const CollectedSignals& signals, const PipeSender& out) {
  out.number(ApartOutcome::found);
  out.number(signals.statements().size());
  for (const CollectedSignals::Statement& one : signals.statements()) {
    out.text(one.name);
    out.number(one.interval);
    out.text(one.unit);
  }
  out.number(signals.signals().size());
  for (const CollectedSignals::Signal& signal : signals.signals()) {
    out.text(signal.name);
    out.text(signal.unit);
    out.number(signal.digits);
    out.number(signal.values.size());
    out.bytes(signal.values.data(), signal.values.size() * sizeof(double));
  }
}

/// @returns false where what comes is not whole.
bool receive(PipeReceiver& in, const ReadingLimits& limits, CollectedSignals& signals) {
  std::size_t statements = 0, count = 0;
  if (!in.number(statements)) return false;
  for (std::size_t k = 0; k < statements; ++k) {
    CollectedSignals::Statement one;
    if (!in.text(one.name) || !in.number(one.interval) || !in.text(one.unit)) return false;
    signals.add_statement(std::move(one));
  }
  if (!in.number(count)) return false;
  for (std::size_t k = 0; k < count; ++k) {
    CollectedSignals::Signal signal;
    std::size_t size = 0;
    if (!in.text(signal.name) || !in.text(signal.unit) || !in.number(signal.digits) || !in.number(size) ||
        size > limits.numbers)
      return false;
    signal.values.resize(size);
    if (!in.bytes(signal.values.data(), size * sizeof(double))) return false;
    signals.add_numbers(std::move(signal.name), std::move(signal.unit), std::move(signal.values),
                        signal.digits);
  }
  return true;
}

/// The error of `what`, which begins with the file's name already.
InputError refusal(const std::string& file, const std::string& what) {
  const std::string start = file + ": ";
  return InputError({file}, clean_text(what.starts_with(start) ? what.substr(start.size()) : what));
}

int wait_for(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace

ReadingLimits reading_limits(std::size_t file_bytes) {
  constexpr std::size_t compression = 1100;  // more than deflate ever reaches
  constexpr std::size_t most = std::size_t{1} << 25, spare = std::size_t{256} << 20;
  ReadingLimits limits;
  limits.numbers = std::min(file_bytes * compression / 4 + 64, std::max(most, file_bytes));
  limits.seconds = 1.0 + 4.0 * static_cast<double>(file_bytes) / 1e6;
  // What a file claims is not taken for granted: this process holds the numbers twice beside the child.
  const auto fitting = static_cast<std::size_t>(std::min(memory_left() / (5 * sizeof(double)), 1e15));
  limits.numbers = std::min(limits.numbers, fitting);
  limits.bytes = spare + 3 * sizeof(double) * limits.numbers;
  return limits;
}

namespace {

/// Answers in a child process. @param answer there; @param take what comes, here: false where it is not
/// whole.
void ask_apart(const std::string& file, const std::string& library, const ReadingLimits& limits,
               const std::function<void(const PipeSender&)>& answer,
               const std::function<bool(PipeReceiver&)>& take) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw std::runtime_error("no pipe for a process that reads '" + file + "': " + std::strerror(errno));
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    work(ends[1], limits, answer);
  }
  const int reason = errno;
  close(ends[1]);
  // Whoever waits for a disk or for others on the machine takes no processor time.
  const double patience = 60.0 + 10.0 * limits.seconds;  // [s]
  PipeReceiver in(ends[0], SteadyClock::now() + std::chrono::milliseconds(std::llround(1e3 * patience)));
  if (child < 0)
    throw std::runtime_error("no process that reads '" + file + "' can be started: " + std::strerror(reason));

  ApartOutcome outcome{};
  std::string message;
  const bool whole =
      in.number(outcome) && (outcome == ApartOutcome::found     ? take(in)
                             : outcome == ApartOutcome::refused ? in.text(message)
                                                                : outcome == ApartOutcome::no_memory);
  if (!whole) kill(child, SIGKILL);
  const int status = wait_for(child);
  constexpr const char* expected = "expected an undamaged file";
  const bool ended_by_limit = WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU;
  if (in.late() || ended_by_limit)
    throw InputError({file}, fmt::format("{} has not come to an end with it in {:.0f} s; {}", library,
                                         in.late() ? patience : std::ceil(limits.seconds), expected));
  if (!whole)
    throw InputError(
        {file},
        fmt::format("{} crashes on it ({} {}); {}", library, WIFSIGNALED(status) ? "signal" : "exit code",
                    WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status), expected));
  if (outcome == ApartOutcome::no_memory)
    throw InputError(
        {file}, fmt::format("{} needs more than {} MB of memory for it; {}, or one that holds less", library,
                            limits.bytes >> 20, expected));
  if (outcome == ApartOutcome::refused) throw refusal(file, message);
}

}  // namespace

CollectedSignals read_apart(const std::string& file, const std::string& library, const ReadingLimits& limits,
                            const std::function<void(CollectedSignals&)>& read) {
  CollectedSignals signals(file, limits.numbers);
  ask_apart(
      file, library, limits,
      [&](const PipeSender& out) {
        CollectedSignals found(file, limits.numbers);
        read(found);
        send(found, out);
      },
      [&](PipeReceiver& in) { return receive(in, limits, signals); });
  return signals;
}

std::vector<std::string> texts_apart(const std::string& file, const std::string& library,
                                     const ReadingLimits& limits,
                                     const std::function<std::vector<std::string>()>& read) {
  std::vector<std::string> texts;
  ask_apart(
      file, library, limits,
      [&](const PipeSender& out) {
        const std::vector<std::string> found = read();
        out.number(ApartOutcome::found);
        out.number(found.size());
        for (const std::string& text : found) out.text(text);
      },
      [&](PipeReceiver& in) {
        std::size_t count = 0;
        if (!in.number(count)) return false;
        for (std::size_t k = 0; k < count; ++k)
          if (!in.text(texts.emplace_back(), limits.bytes)) return false;
        return true;
      });
  return texts;
}

}  // namespace beamid::experiments
