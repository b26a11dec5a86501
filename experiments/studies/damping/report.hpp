// Whether one damping law holds in several records.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/damping_law/damping_law.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

// The law of damping of one record as text, tables, figures and JSON.

/// Tables, figures, words and results.json keys of `beamid identify --damping-law`.
Results report(const Experiment& experiment, const Record& record, const std::string& record_name,
               const DampingLawStudy& study);

struct StudiedRecord {
  std::string name;
  Record record;
  DampingLawStudy study;
};

/// The law that one record supports against the sections of another, at amplitudes that both show.
struct ComparedLaw {
  std::size_t law = 0, sections = 0;  ///< records
  LawMisfit misfit;                   ///< not tested where they have no amplitude in common
};

/// Every record's law against every other record's sections. Both records' noise counts: the variance of a
/// section is its own and that of a section of the law's record at the same amplitude.
std::vector<ComparedLaw> compared_laws(const std::vector<StudiedRecord>& records);

/// Tables, words and results.json keys of `beamid identify A B ... --damping-law`.
Results report(const Experiment& experiment, const std::vector<StudiedRecord>& records);

// What a record says of damping laws, in sentences.

const char* law_title(const std::string& law);
std::string law_verdict(const DampingLawStudy& study);  ///< which law, by how much, and over what amplitudes
std::string law_fit_words(const DampingLawStudy& study);  ///< whether the best of them is good enough

/// What the record supports, and whether that fits: sentences.
std::string law_words(const DampingLawStudy& study);

}  // namespace beamid::experiments
