// Least-squares complex frequency estimation from the frequency responses of a hammer test [guillaume1998].
#include <stdexcept>

#include "experiments/modal/input_responses.hpp"

namespace beamid::experiments {
namespace {

const bool frf_lscf_registered = modal_method_registry().add(
    {"frf_lscf",
     "least-squares complex frequency estimation from hammer hits, with modal masses; needs a force",
     "[guillaume1998], [verboven2002], [cauberghe2004], [cauberghe2005]",
     {{"estimator", std::string("h1"), "", "h1: noise in the response; h2: noise in the force"},
      {"window_end", 0.001, "", "the value of the exponential window at the end of a hit; 1: no window"}},
     {contract::frequency_response},
     [](const filters::Options& options) {
       if (const std::string& word = options.text("estimator"); word != "h1" && word != "h2")
         throw std::invalid_argument("frf_lscf: estimator is '" + word + "'; expected h1 or h2");
       return common_denominator_method("frf_lscf needs a measured force; era takes a record without one");
     }});

}  // namespace
}  // namespace beamid::experiments
