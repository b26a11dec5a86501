#include "experiments/results/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): more of POSIX than <csignal> promises
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <stdexcept>

namespace beamid::experiments {

namespace {

using SteadyClock = std::chrono::steady_clock;

/// Whether something can be read before the deadline.
bool wait_for(int descriptor, const std::optional<SteadyClock::time_point>& deadline) {
  for (;;) {
    int left = -1;  // [ms]
    if (deadline) {
      const auto span = std::chrono::ceil<std::chrono::milliseconds>(*deadline - SteadyClock::now()).count();
      left = static_cast<int>(std::clamp<decltype(span)>(span, 0, 3'600'000));
    }
    pollfd watched{descriptor, POLLIN, 0};
    const int ready = poll(&watched, 1, left);
    if (ready > 0) return true;
    if (ready == 0 && SteadyClock::now() >= *deadline) return false;
    if (ready < 0 && errno != EINTR) return true;  // read() says what is wrong
  }
}

}  // namespace

ProcessResult run_process(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                          double longest) {
  std::optional<SteadyClock::time_point> deadline;
  if (longest > 0.0)
    deadline = SteadyClock::now() +
               std::chrono::duration_cast<SteadyClock::duration>(std::chrono::duration<double>(longest));
  const std::string& program = arguments.at(0);
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);

  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw std::runtime_error("cannot start '" + program + "': " + std::strerror(errno));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  pid_t child = 0;
  const int reason = posix_spawnp(&child, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (reason != 0) {
    close(ends[0]);
    throw std::runtime_error("cannot start '" + program + "': " + std::strerror(reason));
  }

  ProcessResult result;
  std::array<char, 4096> buffer;
  while ((result.ended = wait_for(ends[0], deadline))) {
    const ssize_t count = read(ends[0], buffer.data(), buffer.size());
    if (count > 0)
      result.output.append(buffer.data(), static_cast<std::size_t>(count));
    else if (count == 0 || errno != EINTR)
      break;
  }
  if (!result.ended) kill(child, SIGKILL);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

}  // namespace beamid::experiments
