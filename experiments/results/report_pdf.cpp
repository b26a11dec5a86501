#include "experiments/results/report_pdf.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "experiments/results/process.hpp"

namespace beamid::experiments {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> browsers{"chromium", "chromium-browser", "google-chrome",
                                        "google-chrome-stable"};

bool is_pdf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(4, ' ');
  return stream.read(head.data(), 4) && head == "%PDF";
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

std::string browser_for_pdf() {
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

void print_pdf(const fs::path& page, const fs::path& pdf) {
  const std::string browser = browser_for_pdf();
  const Profile profile;
  const fs::path printed = profile.folder() / "page.pdf";
  std::vector<std::string> words{"timeout",  // coreutils: a browser that waits for something waits for ever
                                 "120",
                                 browser,
                                 "--headless",
                                 "--disable-gpu",
                                 "--no-first-run",
                                 "--disable-dev-shm-usage",
                                 "--user-data-dir=" + profile.folder().string(),
                                 "--no-pdf-header-footer",
                                 "--print-to-pdf=" + printed.string()};
  if (geteuid() == 0) words.insert(words.begin() + 3, "--no-sandbox");  // it starts as root only without
  words.push_back(address_of(page));
  const ProcessResult result = run_process(words, profile.folder());
  if (result.exit_code != 0 || !is_pdf(printed))
    throw std::runtime_error(
        fmt::format("{} has printed nothing (exit code {}): {}", browser, result.exit_code, result.output));
  const fs::path beside = pdf.string() + ".partial-" + std::to_string(getpid());
  fs::copy_file(printed, beside, fs::copy_options::overwrite_existing);
  fs::rename(beside, pdf);
}

}  // namespace beamid::experiments
