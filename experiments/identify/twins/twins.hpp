// Every set of parameters that explains the modes as well.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/identify/update/modal_model.hpp"
#include "experiments/identify/update/updating.hpp"

namespace beamid::experiments {

/// How a list of sets was found, and whether it can lack one.
struct TwinSearch {
  enum class Method {
    all_solutions,  ///< every complex solution of the polynomials was found (spectrum_solutions.hpp)
    starts          ///< searches from many starts
  };
  Method method = Method::starts;
  std::string reason = {};                       ///< why not all_solutions, a clause
  std::size_t complex_solutions = 0, found = 0;  ///< all_solutions
  std::vector<Eigen::VectorXd> values = {};      ///< (q) that meet all frequencies exactly
  bool complete() const { return method == Method::all_solutions && found == complex_solutions; }
};

/// The sets that meet the measured frequencies exactly, all of them, where the structure is one of n springs
/// on n degrees of freedom with known masses, every spring is asked about by itself, and all n frequencies
/// were measured: a chain storey by storey. Elsewhere no values, and the reason.
TwinSearch exact_twins(const ModalModel& model, const ModalData& data, const Progress& progress = unwatched);

/// Whether [[parameters]] asks about a stiffness by this quantity, of which there may be twins.
bool is_stiffness(const std::string& quantity);

/// Probability that one more start would end at a set not seen yet [good1953]: sets seen once, over starts.
double unseen_probability(const Updating& updating);
/// Whether that is above a half: nearly every start ended at a place of its own.
bool starts_say_little(const Updating& updating);

}  // namespace beamid::experiments
