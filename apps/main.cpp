// The `beamid` command. A command with methods of one's own has the same line (docs/tutorials).
#include <malloc.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>

#include "apps/command.hpp"

namespace {

/// Where nothing catches: before main(), or in what may not throw.
[[noreturn]] void end_at_once() {
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    using beamid::apps::no_memory;
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, no_memory, sizeof no_memory - 1);
    [[maybe_unused]] const ssize_t ended = ::write(STDERR_FILENO, "\n", 1);
    _exit(1);
  } catch (...) {
  }
  std::abort();
}

/// Before all else that is done before main(). A file of the largest size allowed (`ulimit -f`) is an error
/// of the write then, as a full disk is, and no signal.
[[gnu::constructor(101)]] void prepare_for_the_worst() {
  std::set_terminate(end_at_once);
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace

int main(int count, char** words) {
  // Blocks of a record's size are used again: given back and asked for anew, their pages are cleared each
  // time, a tenth of the processor time of a million samples.
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  return beamid::apps::run_command_line(count, words);
}
