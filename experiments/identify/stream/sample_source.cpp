#include "experiments/identify/stream/sample_source.hpp"

#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "experiments/text/fields.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::experiments {

filters::Sample read_sample(const std::string& line, Eigen::Index outputs, const Place& place) {
  std::vector<std::string_view> fields;
  split_fields(std::string_view(line).substr(0, line.find_last_not_of('\r') + 1), ',', fields, true);
  const auto found = static_cast<Eigen::Index>(fields.size());
  if (found != outputs + 1)
    throw InputError(place, fmt::format("{} fields; expected {}: a time and {} output{}, parted by commas",
                                        found, outputs + 1, outputs, outputs == 1 ? "" : "s"));
  filters::Sample sample;
  sample.output.resize(outputs);
  for (Eigen::Index i = 0; i <= outputs; ++i) {
    const std::string_view field = fields[static_cast<std::size_t>(i)];
    const Place here{place.file, place.line, static_cast<std::size_t>(field.data() - line.data()) + 1};
    const ParsedNumber parsed = parse_number(field);
    const bool out_of_range = parsed.number && !parsed.finite && std::isfinite(parsed.value);
    if (!field.empty() && (!parsed.number || out_of_range))
      throw InputError(
          here, fmt::format("'{}'; expected a number, or an empty field where none was measured", field));
    if (i == 0 && !parsed.finite) throw InputError(here, "no time; expected seconds");
    (i == 0 ? sample.time : sample.output[i - 1]) =
        field.empty() ? std::numeric_limits<double>::quiet_NaN() : parsed.value;
  }
  return sample;
}

namespace {

[[noreturn]] void fail(const char* what) {
  throw std::runtime_error(fmt::format("{}: {}", what, std::strerror(errno)));
}

bool is_ignored(int number) {
  struct sigaction action {};
  return sigaction(number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

// A signal comes to any thread that does not block it, to those of TBB as well: its handler writes its number
// into a pipe, which next() waits for beside the samples.
struct SampleSource::Before {
  std::array<int, 2> pipe{-1, -1};
  std::vector<std::pair<int, struct sigaction>> actions;
};

namespace {

volatile std::sig_atomic_t writing_end = -1;

void write_number(int number) {
  const int before = errno;
  const char byte = static_cast<char>(number);
  [[maybe_unused]] const ssize_t written = ::write(writing_end, &byte, 1);  // full: a signal is there already
  errno = before;
}

}  // namespace

SampleSource::SampleSource(int descriptor) : descriptor_(descriptor), before_(std::make_unique<Before>()) {
  if (::pipe2(before_->pipe.data(), O_CLOEXEC | O_NONBLOCK) != 0) fail("waiting for signals");
  signals_ = before_->pipe[0];
  writing_end = before_->pipe[1];
  const auto take = [this](int number, void (*handler)(int)) {
    struct sigaction action {
    }, before{};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;  // rows that are being written are written
    if (sigaction(number, &action, &before) == 0) before_->actions.emplace_back(number, before);
  };
  for (const int number : {SIGINT, SIGTERM, SIGHUP})
    if (!is_ignored(number)) take(number, write_number);
  take(SIGPIPE, SIG_IGN);
}

SampleSource::~SampleSource() {
  for (const auto& [number, action] : before_->actions) sigaction(number, &action, nullptr);
  for (const int end : before_->pipe) ::close(end);
}

bool SampleSource::next(std::string& line) {
  for (;;) {
    const std::size_t end = buffer_.find('\n', begin_);
    const std::size_t size = (end == std::string::npos ? buffer_.size() : end) - begin_;
    if (size > longest)
      throw InputError({"standard input", number_ + 1, longest + 1},
                       fmt::format("a line of more than {} characters; expected a sample in each", longest));
    if (end != std::string::npos || (ended_ && size > 0)) {
      line.assign(buffer_, begin_, size);
      begin_ = end == std::string::npos ? buffer_.size() : end + 1;
      ++number_;
      return true;
    }
    if (ended_ || !read_more()) return false;
  }
}

// False when a signal has come.
bool SampleSource::read_more() {
  buffer_.erase(0, begin_);
  begin_ = 0;
  std::array<pollfd, 2> waited{{{signals_, POLLIN, 0}, {descriptor_, POLLIN, 0}}};
  if (::poll(waited.data(), waited.size(), -1) < 0) {
    if (errno == EINTR) return true;
    fail("waiting for samples");
  }
  if (waited[0].revents != 0) {
    char number = 0;
    if (::read(signals_, &number, 1) == 1) signal_ = number;
    return signal_ == 0;
  }
  std::array<char, 65536> bytes{};
  const ssize_t count = ::read(descriptor_, bytes.data(), bytes.size());
  if (count < 0 && errno == EINTR) return true;
  if (count < 0) fail("reading samples");
  ended_ = count == 0;
  buffer_.append(bytes.data(), static_cast<std::size_t>(count));
  return true;
}

}  // namespace beamid::experiments
