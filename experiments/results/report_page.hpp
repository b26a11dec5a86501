// Results as one page that needs no network and no other file: read in any browser, printed to PDF.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// What one command found, as a part of a page: the command that repeats it, what it printed, its figures.
struct ReportSection {
  std::string title;
  std::string html;
};

/// @param folder where the figures have been written
/// @throws std::runtime_error when a figure's SVG cannot be read.
ReportSection report_section(const Results& results, const std::filesystem::path& folder);

/// The page; several sections get a list of contents.
std::string report_page(const std::vector<ReportSection>& sections);

/// The sections of a page that report_page() made; empty when it did not.
std::vector<ReportSection> sections_of(const std::string& page);

/// The name of the first tag in a section that report_section() never writes; empty where there is none. A
/// page from elsewhere may not bring scripts, frames or files along.
std::string foreign_tag(std::string_view html);

/// The command that repeats a section, as report_section() wrote it; empty where it did not.
std::string command_of(const ReportSection& section);

}  // namespace beamid::experiments
