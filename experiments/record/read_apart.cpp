#include "experiments/record/read_apart.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <map>
#include <new>
#include <stdexcept>
#include <string>

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): more of POSIX than <csignal> promises
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "experiments/record/recognised_column.hpp"
#include "experiments/record/record.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/memory_need.hpp"

namespace beamid::experiments {
namespace {

/// "data.time" -> "time".
std::string last_part(const std::string& name) {
  const std::size_t at = name.find_last_of("./");
  return at == std::string::npos ? name : name.substr(at + 1);
}

/// What a name says of times: "t" and "time" nothing, "time_ms" the unit.
struct TimeName {
  bool time = false;
  std::string unit;
};

TimeName time_name(const std::string& name) {
  const std::string last = last_part(name);
  if (last == "t" || last == "time" || last == "Time") return {true, ""};
  for (const Unit& unit : time_units())
    if (last == "time_" + unit.suffix || last == "t_" + unit.suffix) return {true, unit.symbol};
  return {};
}

}  // namespace

void CollectedSignals::announce(const std::string& name, const std::vector<std::size_t>& extent) {
  double count = 1.0;
  for (const std::size_t size : extent) count *= static_cast<double>(size);
  announced_ += count;
  if (announced_ > static_cast<double>(most_numbers_))
    throw InputError(
        {file_}, fmt::format("'{}' claims {} numbers, {:.3g} with those before it; expected at most "
                             "{:.3g} in all, which a file of this size can hold",
                             name, fmt::join(extent, " x "), announced_, static_cast<double>(most_numbers_)));
}

void CollectedSignals::add(std::string name, std::string unit, std::vector<double> values, int digits) {
  for (double& value : values)
    if (!std::isfinite(value)) value = std::nan("");
  if (values.size() > 1) signals_.push_back({std::move(name), std::move(unit), std::move(values), digits});
}

void CollectedSignals::add_matrix(const std::function<std::string(std::size_t, bool)>& name_of,
                                  const std::string& unit, const std::vector<double>& values,
                                  std::size_t rows, std::size_t columns, int digits) {
  constexpr std::size_t most_signals = 4096;
  const bool by_rows = rows < columns;
  const std::size_t count = std::min(rows, columns), length = std::max(rows, columns);
  if (count > most_signals)
    throw InputError({file_}, fmt::format("{} is {} x {}; expected at most {} channels", name_of(1, by_rows),
                                          rows, columns, most_signals));
  for (std::size_t k = 0; k < count; ++k) {
    std::vector<double> signal(length);
    for (std::size_t i = 0; i < length; ++i)
      signal[i] = by_rows ? values[k + i * rows] : values[i + k * rows];
    add(name_of(k + 1, by_rows), unit, std::move(signal), digits);
  }
}

bool CollectedSignals::set(const std::string& name, double value) {
  const std::string last = last_part(name);
  const SamplingName what = sampling_name(last);
  if (what == SamplingName::none) return false;
  if (!(value > 0 && std::isfinite(value)))
    throw InputError({file_}, fmt::format("{} is {}; expected a positive number", name, value));
  const double stated = what == SamplingName::rate ? 1 / value : value;
  if (interval_ > 0 && std::abs(stated - interval_) > 1e-9 * interval_)
    throw InputError({file_}, fmt::format("{} means an interval of {} s beside one of {} s; expected one",
                                          name, stated, interval_));
  set_interval(name, stated);
  return true;
}

void CollectedSignals::find_time(RecordTable& table, const RecordFormat& format) const {
  const auto at = std::find_if(table.names.begin(), table.names.end(),
                               [](const std::string& name) { return time_name(name).time; });
  if (at == table.names.end()) {
    if (interval_ > 0) table.clock = {0.0, interval_};
    return;
  }
  const auto column = static_cast<std::size_t>(at - table.names.begin());
  const std::string named = time_name(*at).unit;
  std::string& unit = table.units[column];
  if (unit.empty()) unit = named;
  if (unit.empty() && !format.time)
    table.remarks.push_back(fmt::format("'{}' states no unit: its times are taken as seconds.", *at));
  const auto factor = seconds_per(unit, "'" + *at + "'", file_, format);
  if (!factor) return;
  if (!named.empty() && *factor != *seconds_per(named, *at, file_, format))
    throw InputError({file_}, fmt::format("'{}' is in '{}'; expected the unit of its name", *at, unit));
  if (*factor == 1.0) table.time = column;  // else found by its unit
  const std::vector<double>& times = table.columns[column];
  const double mean = *factor * (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  constexpr double tolerated = 0.02;
  if (interval_ > 0 && !format.time && !format.sampling_rate &&
      std::abs(mean - interval_) > tolerated * interval_)
    throw InputError(
        {file_},
        fmt::format("{} means an interval of {:.6g} s, and '{}' has one of {:.6g} s; expected them to "
                    "agree, or record.time or record.sampling_rate_hz in the configuration",
                    interval_name_, interval_, *at, mean));
}

RecordTable CollectedSignals::table(const RecordFormat& format) const {
  std::map<std::size_t, std::size_t> numbers;  // of each length
  for (const Signal& signal : signals_) numbers[signal.values.size()] += signal.values.size();
  if (numbers.empty())
    throw InputError({file_},
                     "no signal of at least two numbers; expected vectors or matrices of real numbers");
  const std::size_t length =
      std::max_element(numbers.begin(), numbers.end(), [](const auto& a, const auto& b) {
        return a.second < b.second;
      })->first;
  RecordTable table;
  table.file = file_;
  std::string others;
  for (const Signal& signal : signals_) {
    if (signal.values.size() != length) {
      others += fmt::format("{}{} ({})", others.empty() ? "" : ", ", signal.name, signal.values.size());
      continue;
    }
    table.names.push_back(signal.name);
    table.units.push_back(signal.unit);
    table.columns.push_back(signal.values);
    table.precision.push_back(PrintedPrecision::of_digits(signal.digits));
  }
  find_time(table, format);
  table.by_people = true;
  for (std::size_t i = 0; i < table.width(); ++i) {
    const auto meaning = parse_column_name(table.names[i]);
    const auto unit = stated_unit(table.units[i]);
    if ((meaning && meaning->quantity) || (unit && unit->quantity)) table.by_people = false;
  }
  const auto stated = [&](std::size_t i) { return table.time != i && !table.units[i].empty(); };
  bool units = false;
  for (std::size_t i = 0; i < table.width(); ++i) units = units || stated(i);
  if (!units) table.units.clear();
  if (!others.empty())
    table.remarks.push_back(fmt::format("Omitted, as not of {} samples: {}.", length, others));
  return table;
}

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
  bool text(std::string& text);  ///< of at most 1 MiB
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

bool PipeReceiver::text(std::string& text) {
  constexpr std::size_t longest = std::size_t{1} << 20;
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

[[noreturn]] void work(int descriptor, const std::string& file, const ReadingLimits& limits,
                       const std::function<void(CollectedSignals&)>& read) {
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
    CollectedSignals signals(file, limits.numbers);
    read(signals);
    out.number(ApartOutcome::found);
    out.number(signals.interval());
    out.text(signals.interval_name());
    out.number(signals.signals().size());
    for (const CollectedSignals::Signal& signal : signals.signals()) {
      out.text(signal.name);
      out.text(signal.unit);
      out.number(signal.digits);
      out.number(signal.values.size());
      out.bytes(signal.values.data(), signal.values.size() * sizeof(double));
    }
  } catch (const std::bad_alloc&) {
    out.number(ApartOutcome::no_memory);
  } catch (const std::exception& error) {
    out.number(ApartOutcome::refused);
    out.text(error.what());
  }
  _exit(0);
}

/// @returns false where what comes is not whole.
bool receive(PipeReceiver& in, const ReadingLimits& limits, CollectedSignals& signals) {
  double interval = 0.0;
  std::string interval_name;
  std::size_t count = 0;
  if (!in.number(interval) || !in.text(interval_name) || !in.number(count)) return false;
  if (interval > 0) signals.set_interval(interval_name, interval);
  for (std::size_t k = 0; k < count; ++k) {
    CollectedSignals::Signal signal;
    std::size_t size = 0;
    if (!in.text(signal.name) || !in.text(signal.unit) || !in.number(signal.digits) || !in.number(size) ||
        size > limits.numbers)
      return false;
    signal.values.resize(size);
    if (!in.bytes(signal.values.data(), size * sizeof(double))) return false;
    signals.add(std::move(signal.name), std::move(signal.unit), std::move(signal.values), signal.digits);
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

CollectedSignals read_apart(const std::string& file, const std::string& library, const ReadingLimits& limits,
                            const std::function<void(CollectedSignals&)>& read) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw std::runtime_error("no pipe for a process that reads '" + file + "': " + std::strerror(errno));
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    work(ends[1], file, limits, read);
  }
  const int reason = errno;
  close(ends[1]);
  // Whoever waits for a disk or for others on the machine takes no processor time.
  PipeReceiver in(ends[0], SteadyClock::now() +
                               std::chrono::milliseconds(std::llround(1e3 * (60 + 10 * limits.seconds))));
  if (child < 0)
    throw std::runtime_error("no process that reads '" + file + "' can be started: " + std::strerror(reason));

  CollectedSignals signals(file, limits.numbers);
  ApartOutcome outcome{};
  std::string message;
  const bool whole =
      in.number(outcome) && (outcome == ApartOutcome::found     ? receive(in, limits, signals)
                             : outcome == ApartOutcome::refused ? in.text(message)
                                                                : outcome == ApartOutcome::no_memory);
  if (!whole) kill(child, SIGKILL);
  const int status = wait_for(child);
  constexpr const char* expected = "expected an undamaged file";
  const bool ended_by_limit = WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU;
  if (in.late() || ended_by_limit)
    throw InputError({file}, fmt::format("{} has not come to an end with it in {:.0f} s; {}", library,
                                         std::ceil(limits.seconds), expected));
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
  return signals;
}

LoadedLibrary::LoadedLibrary(const std::string& file, const char* name, const char* package)
    : handle_(dlopen(name, RTLD_NOW | RTLD_LOCAL)) {
  if (handle_ == nullptr)
    throw InputError({file, 0, 0}, fmt::format("cannot be read without {}; expected that library: it is in "
                                               "Debian's package {}",
                                               name, package));
}

void* LoadedLibrary::symbol(const char* name) const {
  void* const found = dlsym(handle_, name);
  if (found == nullptr) throw std::runtime_error(std::string("a library without ") + name);
  return found;
}

}  // namespace beamid::experiments
