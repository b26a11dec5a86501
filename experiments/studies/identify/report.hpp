// An identification from several records as text, tables, figures and JSON.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/identified_parameters.hpp"
#include "experiments/identify/engine/joint_comparison.hpp"
#include "experiments/identify/engine/record_identification.hpp"
#include "experiments/identify/family/beam_family.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/results/figure.hpp"
#include "experiments/results/results.hpp"
#include "filters/diagnostics.hpp"
#include "filters/gaussian.hpp"

namespace beamid::experiments {

// A comparison over several records as text, tables, figures and JSON.

/// Tables, figures, words and results.json keys.
Results report(const Experiment& experiment, const JointComparison& joint);

// Estimates of a family of beams as text, tables, figures and JSON.

/// Tables, figures, words and results.json keys.
Results report(const BeamFamily& family);

/// Tables, figures, words and results.json keys.
Results report(const Experiment& experiment, const JointIdentification& joint);

// An identification of one record as text, tables, figures and JSON.

/// Tables, figures, words and results.json keys.
Results report(const Experiment& experiment, const Record& record, const std::string& record_name,
               const RecordIdentification& found);

// What a filter shows about itself, as numbers, words and pictures.

// The numbers of an identification, as they stand in results.json.

/// The keys of results.json.
nlohmann::ordered_json values(const RecordIdentification& found, const Record& record);

/// All that was set, given or worked out.
nlohmann::ordered_json configuration(const Experiment& experiment, const Record& record,
                                     const RecordIdentification& found, const std::string& record_name);

// What the whole record says of every instant, as a file and a picture.

/// What a filter and a smoother made of a record.
struct SmoothedRecord {
  const Eigen::VectorXd& time;  ///< of the samples (N) [s]
  const JointModel& model;
  const std::vector<filters::Gaussian>& filtered;  ///< (N)
  const std::vector<filters::Gaussian>& smoothed;  ///< (N)
};

/// smoothed.csv: time_s, then mean and standard deviation of every state at every sample.
Attachment smoothed_history(const SmoothedRecord& record);

/// The first coordinate over six cycles of the frequency, up to three unknowns over the record: the filter's
/// and the smoother's, with bands of 95 %.
Figure smoothed_figure(const SmoothedRecord& record, double frequency_hz);

// The report of one record identified with any model but K and C of a free decay.

/// That of a comparison of one run, its status, what the filter's innovations say, and what was asked for
/// beside it: a smoother's history, the batch estimate.
Results identification_report(const Experiment& experiment, const Comparison& found);

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
