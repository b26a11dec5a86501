// The posterior of parameters as a user sees it.
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/posterior/posterior_study.hpp"
#include "experiments/results/results.hpp"
#include "experiments/text/objection.hpp"

namespace beamid::experiments {

/// Verdict, parameters, humps, predictions, what would decide; a figure; results.json; draws.h5.
Results posterior_report(const Experiment& experiment, const PosteriorStudy& study);

/// Whether the draws may be relied upon, how many humps there are and how wide Laplace's normal density is.
std::string posterior_verdict(const PosteriorStudy& study);
/// Where the prior, not what was measured, decides: a warning each.
std::vector<Objection> prior_objections(const PosteriorStudy& study);
/// What else there is to say, a sentence each.
std::vector<std::string> posterior_sentences(const PosteriorStudy& study);
Table posterior_table(const PosteriorStudy& study);
Table hump_table(const PosteriorStudy& study);
Table prediction_table(const PosteriorStudy& study);
/// Every parameter against every other, their densities on the diagonal.
Figure corner_figure(const PosteriorStudy& study);
nlohmann::ordered_json posterior_values(const PosteriorStudy& study);

/// HDF5 as netCDF 4 lays it out, which ArviZ reads: group `posterior`, a variable (chain x draw) for each
/// parameter; group `sample_stats`, `lp` and `hump`. @throws std::runtime_error when it cannot be written.
void write_draws(const PosteriorStudy& study, const std::filesystem::path& file);

}  // namespace beamid::experiments
