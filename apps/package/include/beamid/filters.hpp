// Bayesian filters, discretisations and smoothers, and what their own authors need. Component filters.
#pragma once

#include "filters/batch_estimator.hpp"
#include "filters/central_differences.hpp"
#include "filters/covariance_factor.hpp"
#include "filters/diagnostics.hpp"
#include "filters/filter_run.hpp"
#include "filters/fisher_information.hpp"
#include "filters/identifiability.hpp"
#include "filters/linearised_step.hpp"
#include "filters/monte_carlo.hpp"
#include "filters/noise_estimation.hpp"
#include "filters/random.hpp"
#include "filters/running_filter.hpp"
#include "filters/scheme.hpp"
#include "filters/smoother.hpp"
#include "filters/whole_number.hpp"
