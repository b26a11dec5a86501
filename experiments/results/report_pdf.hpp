// A page as PDF, as a browser prints it.
#pragma once

#include <filesystem>
#include <string>

namespace beamid::experiments {

/// The name of one that is on PATH: chromium or google-chrome.
/// @throws std::invalid_argument when there is none.
std::string browser_for_pdf();

/// Prints the page by Chromium or Chrome, without a window and without the network. A browser, since the page
/// is made for one: its tables, breaks and vector figures come out as on the screen, which VTK's exporter,
/// made for rendered scenes, has no notion of. The file appears whole or not at all.
/// @throws as browser_for_pdf(); std::runtime_error with its words when it prints nothing.
void print_pdf(const std::filesystem::path& page, const std::filesystem::path& pdf);

}  // namespace beamid::experiments
