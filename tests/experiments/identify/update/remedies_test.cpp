// Which single error of a measurement accounts for modes that nothing explains. Oracle: the error that was
// made.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/identify/update/update_study.hpp"
#include "tests/experiments/identify/update/update_cases.hpp"

namespace beamid::experiments::remedies_test {
namespace {

using Eigen::VectorXd, testing::Contains, testing::HasSubstr;

const VectorXd truth = lbf_per_in * VectorXd{{7.18, 8.08, 9.03, 14.69}};

ModalData measured(std::uint64_t seed) {
  return with_errors(predicted_data(four_storeys(), truth, 4), 0.002, 31, seed);
}

UpdateStudy studied(const ModalData& data) {
  return study_update(four_storeys(), data, {{0.0, 0.0}, 20});
}

TEST(Remedies, NameTheSensorsThatWereExchanged) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    ModalData data = measured(seed);
    for (MeasuredMode& mode : data.modes) std::swap(mode.shape[2], mode.shape[3]);
    const UpdateStudy study = studied(data);
    EXPECT_TRUE(study.updating.refuted);
    EXPECT_THAT(texts(study.objections), Contains(HasSubstr("With sensors 3 and 4 exchanged")));
  }
}

TEST(Remedies, NameTheSensorOfAnotherGain) {
  ModalData data = measured(1);
  for (MeasuredMode& mode : data.modes) mode.shape[3] *= 1.25;
  EXPECT_THAT(texts(studied(data).objections), Contains(HasSubstr("Without sensor 4")));
}

TEST(Remedies, NameTheModeThatIsNone) {
  ModalData data = measured(2);
  MeasuredMode& third = data.modes[2];
  third.frequency_hz *= 0.8;
  third.shape = data.modes[0].shape;
  EXPECT_THAT(texts(studied(data).objections),
              Contains(HasSubstr(fmt::format("Without the mode at {:.4g} Hz", third.frequency_hz))));
}

// Two groups of storeys, three frequencies, the second mode not found: 1, 3 and 4 taken for 1, 2 and 3.
TEST(Remedies, NameTheModeThatIsMissing) {
  const Experiment experiment = experiment_of(
      "[chain]\nmasses_kg = [1000, 1000, 1000, 1000]\nstiffnesses_n_per_m = [2e6, 2e6, 1.5e6, 1.5e6]\n"
      "[[sensors]]\nposition_m = 1\n[[sensors]]\nposition_m = 4\n"
      "[[parameters]]\nquantity = \"storey_stiffness\"\nfrom_m = 0\nto_m = 2\n"
      "[[parameters]]\nquantity = \"storey_stiffness\"\nfrom_m = 2\nto_m = 4\n");
  const ModalData all = predicted_data(experiment, VectorXd{{2.3e6, 1.3e6}}, 4);
  const UpdateStudy study = study_update(
      experiment,
      frequencies({all.modes[0].frequency_hz, all.modes[2].frequency_hz, all.modes[3].frequency_hz}),
      {{0.002, 0.0}, 20});
  EXPECT_TRUE(study.updating.refuted);
  EXPECT_THAT(texts(study.objections), Contains(HasSubstr("Were mode 2 missing")));
}

TEST(Remedies, NothingNeedsOneWhereAllIsWell) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) EXPECT_TRUE(studied(measured(seed)).remedies.empty());
}

// chi^2 of one frequency too many: 1.8 deviations either way are 6.5, above 3.84 (95 %), below 10.8 (99.9 %).
TEST(Remedies, ChanceOnceInTwentyIsPoorAndNoContradiction) {
  const Experiment experiment = experiment_of(
      "[chain]\nmasses_kg = [1000, 1000]\nstiffnesses_n_per_m = [1e6, 1e6]\n[[sensors]]\nposition_m = 2\n"
      "[[parameters]]\nquantity = \"storey_stiffness\"\nfrom_m = 0\nto_m = 2\n");
  ModalData data = predicted_data(
      experiment_of("[chain]\nmasses_kg = [1000, 1000]\nstiffnesses_n_per_m = [1e6, 1e6]\n[[sensors]]\n"
                    "position_m = 1\n[[sensors]]\nposition_m = 2\n"),
      VectorXd{{1e6, 1e6}}, 2);
  for (MeasuredMode& mode : data.modes) mode.shape.resize(0);
  for (const double off : {1.8, 3.0}) {
    ModalData shifted = data;
    shifted.modes[0].frequency_hz *= 1 + 0.002 * off;
    shifted.modes[1].frequency_hz *= 1 - 0.002 * off;
    const UpdateStudy study = study_update(experiment, shifted, {{0.002, 0.0}, 4});
    EXPECT_FALSE(study.updating.explains());
    EXPECT_EQ(study.updating.refuted, off > 2.0) << study.updating.best().fit.chi_square();
  }
}

}  // namespace
}  // namespace beamid::experiments::remedies_test
