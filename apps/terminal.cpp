#include "apps/terminal.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <mutex>

#include "apps/receiver.hpp"
#include "experiments/text/clean_text.hpp"
#include "experiments/text/words.hpp"

namespace beamid::apps {
namespace {

using experiments::Page;

constexpr const char* clear_line = "\r\033[K";

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// 0 where it is not known.
std::size_t columns_of(int terminal) {
  constexpr double narrowest = 20, widest = 1000;
  const auto stated = experiments::number(environment("COLUMNS"));
  if (stated && *stated >= narrowest && *stated <= widest) return static_cast<std::size_t>(*stated);
  winsize size{};
  if (ioctl(terminal, TIOCGWINSZ, &size) != 0 || size.ws_col < narrowest) return 0;
  return size.ws_col;
}

/// Cut to one line of the terminal: a line that breaks is not wiped as a whole.
std::string one_line(const std::string& text) {
  const std::size_t width = columns_of(STDERR_FILENO);
  if (width == 0 || experiments::width_of(text) < width) return text;
  std::string cut;
  for (std::size_t i = 0, shown = 0; i < text.size(); ++i) {
    if ((text[i] & 0xC0) != 0x80 && ++shown >= width) break;
    cut += text[i];
  }
  return cut;
}

}  // namespace

Page terminal_page() {
  Page page;
  if (!isatty(STDOUT_FILENO)) return page;
  if (const std::size_t width = columns_of(STDOUT_FILENO)) page.width = width;
  page.colour = environment("NO_COLOR").empty() && environment("TERM") != "dumb";
  return page;
}

experiments::Progress show_progress(const Values& values) {
  if (Receiver* const receiver = values.receiver())
    return [receiver](const std::string& what) { receiver->progress(what); };
  static std::mutex one_at_a_time;
  if (values.has("verbose"))
    return [started = std::chrono::steady_clock::now()](const std::string& what) {
      const std::chrono::duration<double> since = std::chrono::steady_clock::now() - started;
      const std::lock_guard lock(one_at_a_time);
      std::cerr << fmt::format("{:8.2f} s  {}\n", since.count(), experiments::clean_text(what)) << std::flush;
    };
  if (values.has("quiet") || values.has("no-progress") || !isatty(STDERR_FILENO))
    return [](const std::string&) {};
  return [](const std::string& what) {
    const std::lock_guard lock(one_at_a_time);
    std::cerr << clear_line << one_line(experiments::clean_text(what) + " ...") << std::flush;
  };
}

void clear_progress() {
  if (isatty(STDERR_FILENO)) std::cerr << clear_line << std::flush;
}

}  // namespace beamid::apps
