// Poles of the averaged responses to measured inputs, refined on all lines of the record [guillaume1998].
#include "experiments/modal/input_responses.hpp"

namespace beamid::experiments {
namespace {

const bool output_error_registered = modal_method_registry().add(
    {"output_error",
     "poles of the responses to a moving base or forces that act all the time, refined on all lines",
     "[guillaume1998], [pintelon2012], [golub1973]",
     {},
     {contract::measured_input},
     [](const filters::Options&) {
       return common_denominator_method(
           "output_error needs a measured input; ssi_cov takes a record without one");
     }});

}  // namespace
}  // namespace beamid::experiments
