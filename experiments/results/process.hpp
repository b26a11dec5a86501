// Another program, run to its end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace beamid::experiments {

struct ProcessResult {
  int exit_code = 0;   ///< 128 + signal when a signal ended it
  std::string output;  ///< standard output and standard error, as they came
  bool ended = true;   ///< by itself, within its time
};

/// Runs a program found on PATH in a folder. The arguments reach it as they are: no shell reads them.
/// @param arguments the program first. @param longest [s] it may take, else it is killed; 0: as long as it
/// likes.
/// @throws std::runtime_error when the program cannot be started.
ProcessResult run_process(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                          double longest = 0.0);

// A page as PDF or picture, as a browser prints it.

/// The name of one that is on PATH: chromium or google-chrome.
/// @throws std::invalid_argument when there is none.
std::string browser_on_path();

/// Prints the page by Chromium or Chrome, without a window and without the network: to PDF, or where `file`
/// ends in .png its beginning, 960 x 928 pixels, as it is at rest. A browser, since the page is made for
/// one: its tables, breaks and vector figures come out as on the screen, which VTK's exporter, made for
/// rendered scenes, has no notion of. The file appears whole or not at all.
/// @throws as browser_on_path(); std::runtime_error with its words when it prints nothing.
void print_page(const std::filesystem::path& page, const std::filesystem::path& file);

}  // namespace beamid::experiments
