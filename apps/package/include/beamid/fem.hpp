// The continuum: beams and frames, their equations, modes, responses and exact solutions. Component fem.
#pragma once

#include "fem/assembly.hpp"
#include "fem/beam.hpp"
#include "fem/complex_modes.hpp"
#include "fem/exact/exact_cantilever.hpp"
#include "fem/exact/exact_modes.hpp"
#include "fem/frame.hpp"
#include "fem/free_decay.hpp"
#include "fem/modes.hpp"
#include "fem/parametric_system.hpp"
#include "fem/response/frequency_response.hpp"
#include "fem/response/method.hpp"
#include "fem/response/response.hpp"
#include "fem/space_frame.hpp"
#include "fem/stiffness_solver.hpp"
#include "fem/structural_system.hpp"
