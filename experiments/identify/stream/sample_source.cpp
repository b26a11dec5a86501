#include "experiments/identify/stream/sample_source.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

#include "experiments/text/input_error.hpp"

namespace beamid::experiments {
namespace {

[[noreturn]] void fail(const char* what) {
  throw std::runtime_error(fmt::format("{}: {}", what, std::strerror(errno)));
}

bool is_ignored(int number) {
  struct sigaction action {};
  return sigaction(number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

struct SampleSource::Before {
  sigset_t mask{};
  struct sigaction pipe {};
};

SampleSource::SampleSource(int descriptor) : descriptor_(descriptor), before_(std::make_unique<Before>()) {
  sigset_t ending;
  sigemptyset(&ending);
  for (const int number : {SIGINT, SIGTERM, SIGHUP})
    if (!is_ignored(number)) sigaddset(&ending, number);
  signals_ = signalfd(-1, &ending, SFD_CLOEXEC);
  if (signals_ < 0) fail("waiting for signals");
  pthread_sigmask(SIG_BLOCK, &ending, &before_->mask);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, &before_->pipe);
}

SampleSource::~SampleSource() {
  sigaction(SIGPIPE, &before_->pipe, nullptr);
  pthread_sigmask(SIG_SETMASK, &before_->mask, nullptr);
  ::close(signals_);
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
    signalfd_siginfo told{};
    if (::read(signals_, &told, sizeof told) == sizeof told) signal_ = static_cast<int>(told.ssi_signo);
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
