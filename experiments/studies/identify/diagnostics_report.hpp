// What a filter shows about itself, as numbers, words and pictures.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/results/figure.hpp"
#include "filters/diagnostics.hpp"

namespace beamid::experiments {

/// Keys log_likelihood, whiteness (of each output), innovation_histogram, information.
/// @param outputs names of the measured channels (p)
nlohmann::ordered_json values(const filters::Diagnostics& found, const std::vector<std::string>& outputs);

/// One paragraph.
std::string words(const filters::Diagnostics& found, const std::vector<std::string>& outputs);

/// innovation_autocorrelation with the band of white noise, and innovation_histogram beside N(0, 1); a panel
/// for each of the first six outputs.
std::vector<Figure> figures(const filters::Diagnostics& found, const std::vector<std::string>& outputs);

/// An object with keys step, time_s, reason, smallest_eigenvalue for each; null where no covariance failed.
nlohmann::ordered_json values(const std::vector<filters::Failure>& events);

}  // namespace beamid::experiments
