#include "apps/interruption.hpp"

#include <signal.h>  // NOLINT(modernize-deprecated-headers): more of POSIX than <csignal> promises
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>

namespace beamid::apps {
namespace {

constexpr int ending_signals[] = {SIGINT, SIGTERM};

// Two, so that a signal never meets a sentence half written.
std::array<std::array<char, 1024>, 2> sentences;
std::atomic<int> current{0};

extern "C" void say_and_end(int signal) {
  const char* const text = sentences[static_cast<std::size_t>(current.load())].data();
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, std::strlen(text));
  end_by(signal);
}

}  // namespace

void end_by(int signal) {
  struct sigaction fallback {};
  fallback.sa_handler = SIG_DFL;
  sigaction(signal, &fallback, nullptr);
  raise(signal);
}

Interruption::Interruption(const std::string& sentence) {
  say(sentence);
  for (const int signal : ending_signals) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    // Ignored, as in a shell's background, or the matter of the program around the command.
    if (before.sa_handler != SIG_DFL) continue;
    struct sigaction action {};
    action.sa_handler = say_and_end;
    sigaction(signal, &action, nullptr);
  }
}

Interruption::~Interruption() {
  for (const int signal : ending_signals) {
    struct sigaction now {};
    sigaction(signal, nullptr, &now);
    if (now.sa_handler != say_and_end) continue;
    now.sa_handler = SIG_DFL;
    sigaction(signal, &now, nullptr);
  }
}

void Interruption::say(const std::string& sentence) {
  const int next = 1 - current.load();
  auto& text = sentences[static_cast<std::size_t>(next)];
  const std::string line = "\n" + sentence + "\n";
  const std::size_t size = std::min(line.size(), text.size() - 1);
  std::copy_n(line.begin(), size, text.begin());
  text[size] = '\0';
  current.store(next);
}

}  // namespace beamid::apps
