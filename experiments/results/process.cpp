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
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

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

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> browsers{"chromium", "chromium-browser", "google-chrome",
                                        "google-chrome-stable"};

bool begins_with(const fs::path& file, const std::string& mark) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(mark.size(), ' ');
  return stream.read(head.data(), static_cast<std::streamsize>(head.size())) && head == mark;
}

/// A file's address [rfc3986]: all but plain letters and slashes by their codes, as "#" ends a path.
std::string address_of(const fs::path& file) {
  std::string address = "file://";
  for (const char letter : fs::absolute(file).string()) {
    const auto byte = static_cast<unsigned char>(letter);
    const bool plain = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
                       (letter >= '0' && letter <= '9') ||
                       std::string_view("/-._~").find(letter) != std::string_view::npos;
    address += plain ? std::string(1, letter) : fmt::format("%{:02X}", byte);
  }
  return address;
}

/// The browser's own files, which it would leave in the user's home.
class Profile {
 public:
  Profile() {
    std::string name = (fs::temp_directory_path() / "beamid_browser_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder can be made in " + name);
    folder_ = name;
  }
  ~Profile() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Profile(const Profile&) = delete;
  Profile& operator=(const Profile&) = delete;
  const fs::path& folder() const { return folder_; }

 private:
  fs::path folder_;
};

}  // namespace

std::string browser_on_path() {
  const char* const path = std::getenv("PATH");
  for (const std::string& name : browsers) {
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
      if (!folder.empty() && access((fs::path(folder) / name).c_str(), X_OK) == 0) return name;
  }
  throw std::invalid_argument(
      "a PDF is printed by a browser, and neither chromium nor google-chrome is installed; expected one of "
      "them (Debian: chromium), or --out FILE.html alone, to be printed from any other");
}

void print_page(const fs::path& page, const fs::path& file) {
  const std::string browser = browser_on_path();
  const Profile profile;
  const bool picture = file.extension() == ".png";
  const fs::path printed = profile.folder() / (picture ? "page.png" : "page.pdf");
  std::vector<std::string> words{"timeout",  // coreutils: a browser that waits for something waits for ever
                                 "120",
                                 browser,
                                 "--headless",
                                 "--disable-gpu",
                                 "--no-first-run",
                                 "--disable-dev-shm-usage",
                                 "--user-data-dir=" + profile.folder().string()};
  if (picture)
    words.insert(words.end(),
                 {"--hide-scrollbars", "--force-prefers-reduced-motion", "--force-device-scale-factor=0.8",
                  "--window-size=1200,1160", "--screenshot=" + printed.string()});
  else
    words.insert(words.end(), {"--no-pdf-header-footer", "--print-to-pdf=" + printed.string()});
  if (geteuid() == 0) words.insert(words.begin() + 3, "--no-sandbox");  // it starts as root only without
  words.push_back(address_of(page));
  const ProcessResult result = run_process(words, profile.folder());
  if (result.exit_code != 0 || !begins_with(printed, picture ? "\x89PNG" : "%PDF"))
    throw std::runtime_error(
        fmt::format("{} has printed no page (exit code {}): {}", browser, result.exit_code, result.output));
  const fs::path beside = file.string() + ".partial-" + std::to_string(getpid());
  fs::copy_file(printed, beside, fs::copy_options::overwrite_existing);
  fs::rename(beside, file);
}

}  // namespace beamid::experiments
