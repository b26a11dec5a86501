// Conformance of filters: each keeps the contracts that it declares (filters/filter.hpp), and the manners
// that all share. To be included by one file of a test program, which says what it runs on:
//
//     INSTANTIATE_TEST_SUITE_P(Mine, EveryFilter, testing::Values("fading_ekf"), by_name);
//
// in namespace beamid::test; the program links the file that registers the filter, beamid::filters and
// GTest::gtest_main.
#pragma once

#include "beamid/testing/every_filter.hpp"
#include "beamid/testing/filter/covariance.hpp"
#include "beamid/testing/filter/identification.hpp"
#include "beamid/testing/filter/linear_gaussian.hpp"
#include "beamid/testing/filter/manners.hpp"
#include "beamid/testing/filter/missing_readings.hpp"
#include "beamid/testing/filter/outliers.hpp"
#include "beamid/testing/filter/unknown_inputs.hpp"
#include "beamid/testing/named.hpp"
