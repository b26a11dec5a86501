#include "experiments/record/apart_pipe.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace beamid::experiments {

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

}  // namespace beamid::experiments
