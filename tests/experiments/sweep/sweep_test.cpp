// Oracles: counting by hand; tables worked out by hand; a filter whose model is exact.
#include <gmock/gmock.h>
#include <hdf5.h>

#include <array>
#include <fstream>
#include <numeric>

#include "experiments/results/file.hpp"
#include "experiments/studies/sweep/perform.hpp"
#include "experiments/sweep/hdf5_table.hpp"
#include "experiments/sweep/journal.hpp"
#include "experiments/sweep/manifest.hpp"
#include "experiments/sweep/read_sweep.hpp"
#include "experiments/sweep/repeats.hpp"
#include "experiments/sweep/statistics.hpp"
#include "experiments/sweep/sweep.hpp"
#include "experiments/text/input_error.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/sweep/exact_rig.hpp"

namespace beamid::experiments::sweep_test {
namespace {

namespace fs = std::filesystem;
using filters::OptionValue;
using testing::ElementsAre, testing::HasSubstr, testing::ThrowsMessage;

SweepPlan plan_with(const std::vector<std::string>& vary, int samples = 1, int seeds = 1) {
  SweepPlan plan;
  for (const std::string& text : vary) plan.varied.push_back(parse_varied(text));
  plan.samples = samples;
  plan.seeds = seeds;
  check(plan);
  return plan;
}

std::vector<double> numbers(const VariedKey& key) {
  std::vector<double> found;
  for (const OptionValue& value : key.values) found.push_back(std::get<double>(value));
  return found;
}

TEST(VariedKey, IsARangeAListOrALaw) {
  EXPECT_THAT(numbers(parse_varied("beam.length_m=1:2:3")), ElementsAre(1.0, 1.5, 2.0));
  const std::vector<double> decades = numbers(parse_varied("damping.ratio=0.001:0.1:3:log"));
  EXPECT_EQ(decades[0], 0.001);
  EXPECT_NEAR(decades[1], 0.01, 1e-15);
  EXPECT_EQ(decades[2], 0.1);
  EXPECT_EQ(std::get<std::string>(parse_varied("filter.method=ekf,ukf").values[1]), "ukf");
  EXPECT_EQ(std::get<bool>(parse_varied("filter.inflate=true").values[0]), true);
  EXPECT_EQ(parse_varied("sensors[1].noise_m=normal:1:0.5").law, VariedKey::Law::normal);
}

TEST(VariedKey, RefusesWhatIsNoneOfThem) {
  const auto refuses = [](const char* text, const char* message) {
    EXPECT_THAT([&] { parse_varied(text); }, ThrowsMessage<std::invalid_argument>(HasSubstr(message)))
        << text;
  };
  refuses("ratio=1", "expected TABLE.KEY=");
  refuses("damping.ratio", "expected TABLE.KEY=");
  refuses("damping.ratio=0:1:3:log", "expected positive FROM and TO");
  refuses("damping.ratio=1:2:2.5", "expected a whole number of steps");
  refuses("damping.ratio=1:2:three", "expected a number in the place of 'three'");
  refuses("damping.ratio=uniform:2:1", "expected FROM below TO");
  refuses("damping.ratio=0.1,,0.2", "expected a value between commas");
  EXPECT_THAT([] { check_key(parse_varied("beam.lenght_m=1,2")); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("did you mean 'length_m'?")));
  const auto refuses_key = [](const char* text, const char* message) {
    EXPECT_THAT([&] { check_key(parse_varied(text)); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(message)))
        << text;
  };
  refuses_key("beam.tip_mass_kg=-1,2", "sets beam.tip_mass_kg to -1; expected zero or a positive number");
  refuses_key("beam.elements=10,20.5",
              "sets beam.elements to 20.5; expected a whole number from 1 to 1000000");
  refuses_key("beam.mass_kg=light", "sets beam.mass_kg to light; expected a positive number");
  refuses_key("beam.theory=shear", "expected one of euler_bernoulli, timoshenko");
  refuses_key("filter.method=uniform:1:2", "draws numbers; expected a text in quotes between commas");
  refuses_key("record.window_s=1,2", "holds more than one value; expected a key of one");
  refuses_key("beam.springs=1", "holds more than one value");
  refuses_key("frame.bodies[1].mass_kg=1,2", "is in no table of an experiment file");
  refuses_key("sensors[1.noise_m=1", "has a bracket that is not closed");
  EXPECT_THAT(
      [] {
        plan_with({"beam.length_m=1,2", "beam.length_m=3"});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("varied twice")));
}

TEST(SweepPlan, NumbersSeedsFastestAndTheFirstKeySlowest) {
  const SweepPlan plan = plan_with({"beam.length_m=1,2", "filter.method=ekf,ukf,iekf"}, 1, 4);
  EXPECT_EQ(plan.cases(), 24u);
  EXPECT_EQ(plan.point_of(3), 0u);
  EXPECT_EQ(plan.point_of(4), 1u);
  const std::vector<OptionValue> values = values_of(plan, 17);  // point 4: second length, second filter
  EXPECT_EQ(std::get<double>(values[0]), 2.0);
  EXPECT_EQ(std::get<std::string>(values[1]), "ukf");
}

// Moments of the laws, within five standard errors of 20,000 numbers.
TEST(SweepPlan, DrawsByTheLawAndTheSampleAlone) {
  const SweepPlan plan = plan_with({"a.b=uniform:2:4", "a.c=normal:10:2", "a.d=log_uniform:1:100"}, 20000, 2);
  double uniform = 0.0, normal = 0.0, square = 0.0, logarithm = 0.0;
  for (std::size_t i = 0; i < plan.cases(); i += 2) {
    const auto values = values_of(plan, i);
    EXPECT_EQ(values, values_of(plan, i + 1));  // another seed of the same sample
    uniform += std::get<double>(values[0]) / 20000;
    normal += std::get<double>(values[1]) / 20000;
    square += std::pow(std::get<double>(values[1]) - 10.0, 2) / 20000;
    logarithm += std::log10(std::get<double>(values[2])) / 20000;
  }
  EXPECT_NEAR(uniform, 3.0, 5 * 2.0 / std::sqrt(12.0 * 20000));
  EXPECT_NEAR(normal, 10.0, 5 * 2.0 / std::sqrt(20000.0));
  EXPECT_NEAR(square, 4.0, 5 * 4.0 * std::sqrt(2.0 / 20000));
  EXPECT_NEAR(logarithm, 1.0, 5 * 2.0 / std::sqrt(12.0 * 20000));
}

SweepRow found(std::size_t number, double estimate) {
  SweepRow row;
  row.number = number;
  row.values = {"1"};
  row.filter = "ekf";
  row.status = "converged";
  row.parameter = "stiffness";
  row.unit = "N/m";
  row.estimate = estimate;
  row.truth = 10.0;
  row.error = estimate - 10.0;
  row.deviation = 1.0;
  row.lower = estimate - 1.5;
  row.upper = estimate + 1.5;
  row.bound = 1.0;
  return row;
}

SweepRow not_found(std::size_t number, const std::string& status) {
  SweepRow row;
  row.number = number;
  row.values = {"1"};
  row.filter = status == "failed" ? "" : "ekf";
  row.status = status;
  row.reason = "a \"reason\", on\ntwo lines";
  return row;
}

// By hand: errors 1, -1, 2, 0; three of four within 1.5; Wilson's intervals of 3/4 and 1/5.
TEST(Statistics, AreThoseOfATableWorkedOutByHand) {
  const SweepPlan plan = plan_with({"beam.length_m=1,2"}, 1, 6);
  const auto all = statistics(plan, {found(0, 11), found(1, 9), found(2, 12), not_found(3, "diverged"),
                                     not_found(4, "failed"), found(5, 10), not_found(6, "failed")});
  ASSERT_EQ(all.size(), 2u);
  const PointStatistics& one = all[0];
  EXPECT_EQ(one.converged, 4);
  EXPECT_EQ(one.diverged, 1);
  EXPECT_EQ(one.unusable, 1);
  EXPECT_DOUBLE_EQ(one.bias, 0.5);
  EXPECT_DOUBLE_EQ(one.rms, std::sqrt(1.5));
  EXPECT_DOUBLE_EQ(one.bias_percent, 5.0);
  EXPECT_DOUBLE_EQ(one.rms_percent, 10 * std::sqrt(1.5));
  EXPECT_DOUBLE_EQ(one.bias_percent_error, std::sqrt(125.0 / 3));
  EXPECT_DOUBLE_EQ(one.rms_over_bound, std::sqrt(1.5));
  EXPECT_EQ(one.coverage.value(), 0.75);
  EXPECT_NEAR(one.coverage.lower_95, 0.3006, 1e-4);
  EXPECT_NEAR(one.coverage.upper_95, 0.9544, 1e-4);
  EXPECT_NEAR(one.divergence.lower_95, 0.0362, 1e-4);
  EXPECT_NEAR(one.divergence.upper_95, 0.6245, 1e-4);
  EXPECT_EQ(all[1].point, 1u);
  EXPECT_EQ(all[1].parameter, "");
  EXPECT_EQ(all[1].unusable, 1);
}

TEST(SweepRow, IsReadBackAsItWasWritten) {
  SweepRow row = not_found(7, "diverged");
  row.estimate = 1.0 / 3.0;
  const std::string line = to_line(row);
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  const auto back = from_line(line.substr(0, line.size() - 1), 1);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->estimate, 1.0 / 3.0);
  EXPECT_TRUE(std::isnan(back->bound));
  EXPECT_EQ(back->reason, "a \"reason\", on two lines");
  EXPECT_EQ(to_line(*back), line);
  EXPECT_FALSE(from_line(line.substr(0, line.size() / 2), 1));
}

// Oracle: HDF5 itself, which finds members by name and converts them.
TEST(Hdf5Table, HoldsRowsAsACompoundOfNamedColumns) {
  const TemporaryFile file("cases.h5", "");
  SweepRow second = found(1, 9);
  second.values = {"2.5"};
  write_hdf5(plan_with({"beam.length_m=1,2.5"}), {found(0, 11), second}, file.path());
  const hid_t in = H5Fopen(file.path().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t set = H5Dopen2(in, "cases", H5P_DEFAULT);
  const auto column = [&](const char* name) {
    const hid_t one = H5Tcreate(H5T_COMPOUND, sizeof(double));
    H5Tinsert(one, name, 0, H5T_NATIVE_DOUBLE);
    std::vector<double> values(2, -1.0);
    EXPECT_GE(H5Dread(set, one, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
    H5Tclose(one);
    return values;
  };
  EXPECT_THAT(column("case"), ElementsAre(0.0, 1.0));
  EXPECT_THAT(column("beam.length_m"), ElementsAre(1.0, 2.5));
  EXPECT_THAT(column("error"), ElementsAre(1.0, -1.0));
  const hid_t text = H5Tcopy(H5T_C_S1), one = H5Tcreate(H5T_COMPOUND, 16);
  H5Tset_size(text, 16);
  H5Tinsert(one, "parameter", 0, text);
  std::array<char, 32> names{};
  EXPECT_GE(H5Dread(set, one, H5S_ALL, H5S_ALL, H5P_DEFAULT, names.data()), 0);
  EXPECT_STREQ(names.data() + 16, "stiffness");
  H5Tclose(one);
  H5Tclose(text);
  H5Dclose(set);
  H5Fclose(in);
}

class JournalTest : public testing::Test {
 protected:
  JournalTest() : folder_(fs::path(file_.path()).parent_path() / "kept.partial") { fs::remove_all(folder_); }
  ~JournalTest() override { fs::remove_all(folder_); }

  /// Two cases, the second of two rows.
  void keep_two() const {
    Journal journal(folder_, manifest_, plan_, false);
    journal.append({found(0, 11)});
    SweepRow first = found(1, 9), second = first;
    first.rows = second.rows = second.row = 2;
    journal.append({first, second});
  }
  std::vector<std::size_t> resumed() const {
    std::vector<std::size_t> kept;
    const Journal journal(folder_, manifest_, plan_, true);
    for (const SweepRow& row : journal.kept()) kept.push_back(row.number);
    return kept;
  }
  void add(const std::string& text) const { std::ofstream(folder_ / "cases.csv", std::ios::app) << text; }

  TemporaryFile file_{"empty.toml", ""};
  fs::path folder_;
  SweepPlan plan_ = plan_with({"beam.length_m=1,2"}, 1, 3);
  nlohmann::ordered_json manifest_ = manifest_of({{file_.path(), ""}, {}, {}}, plan_, {});
};

TEST_F(JournalTest, KeepsWholeCasesAndCutsATornOneOff) {
  keep_two();
  const auto size = fs::file_size(folder_ / "cases.csv");
  EXPECT_THAT(resumed(), ElementsAre(0u, 1u, 1u));
  add(to_line(found(2, 12)).substr(0, 20));
  EXPECT_THAT(resumed(), ElementsAre(0u, 1u, 1u));
  EXPECT_EQ(fs::file_size(folder_ / "cases.csv"), size);
}

TEST_F(JournalTest, CutsACaseOffThatLacksARow) {
  keep_two();
  const auto size = fs::file_size(folder_ / "cases.csv");
  SweepRow first = found(2, 12);
  first.rows = 2;
  add(to_line(first));
  EXPECT_THAT(resumed(), ElementsAre(0u, 1u, 1u));
  EXPECT_EQ(fs::file_size(folder_ / "cases.csv"), size);
}

TEST_F(JournalTest, RefusesWhatNoInterruptionLeaves) {
  keep_two();
  EXPECT_THAT([&] { Journal(folder_, manifest_, plan_, false); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("--resume continues it")));
  const nlohmann::ordered_json other = manifest_of({{file_.path(), "#"}, {}, {}}, plan_, {});
  EXPECT_THAT([&] { Journal(folder_, other, plan_, true); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("holds another sweep")));
  {
    const Journal first(folder_, manifest_, plan_, true);
    EXPECT_THAT([&] { Journal(folder_, manifest_, plan_, true); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("in use")));
  }
  add("nonsense\n" + to_line(found(2, 12)));
  EXPECT_THAT([&] { Journal(folder_, manifest_, plan_, true); },
              ThrowsMessage<InputError>(HasSubstr("cases.csv:5:1: no row")));
}

TEST_F(JournalTest, OfASweepThatIsRunningIsNeitherOfferedNorDiscarded) {
  keep_two();
  {
    const Journal running(folder_, manifest_, plan_, true);
    for (const bool resume : {false, true})
      EXPECT_THAT([&] { Journal(folder_, manifest_, plan_, resume); },
                  ThrowsMessage<std::invalid_argument>(HasSubstr("in use by another beamid sweep")));
    EXPECT_FALSE(discard_journal(folder_));
  }
  EXPECT_THAT(resumed(), ElementsAre(0u, 1u, 1u));
  EXPECT_TRUE(discard_journal(folder_));
  EXPECT_FALSE(fs::exists(folder_));
  EXPECT_TRUE(discard_journal(folder_));
}

TEST(RunCases, EndsAllThreadsWithTheFirstTrouble) {
  std::vector<std::size_t> all(1000);
  std::iota(all.begin(), all.end(), std::size_t{0});
  CaseQueue queue(blocks_of({}, all));
  int kept = 0;
  EXPECT_THROW(run_cases(
                   queue, 3, [](const CaseBlock& block) { return std::vector<SweepRow>{found(block[0], 1)}; },
                   [&](std::vector<SweepRow> rows) {
                     if (rows[0].number == 20) throw std::runtime_error("full");
                     ++kept;
                   }),
               std::runtime_error);
  EXPECT_LT(kept, 1000);
}

// Oracle: the filter's own promise. 200 runs of 95 % lie between 90.5 % and 99 % in 99 % of such tests.
TEST(Sweep, FindsTheExactFilterConsistentAndEfficient) {
  const SweepPlan plan = plan_with({}, 1, 200);
  SweepSettings settings;
  settings.threads = 2;
  const auto rows =
      perform({{"rig.toml", test::exact_rig}, {}, {}}, plan, settings, [](const std::string&) {});
  const auto all = statistics(plan, rows);
  ASSERT_EQ(all.size(), 2u);
  for (const PointStatistics& one : all) {
    EXPECT_EQ(one.converged, 200) << one.parameter;
    EXPECT_GE(one.coverage.value(), 0.905) << one.parameter;
    EXPECT_LE(one.coverage.value(), 0.99) << one.parameter;
    EXPECT_LT(std::abs(one.bias_percent), 3.5 * one.bias_percent_error) << one.parameter;
    EXPECT_NEAR(one.rms_over_bound, 1.0, 3.5 / std::sqrt(2.0 * 200)) << one.parameter;
  }
}

SweepPlan once(SweepPlan plan) {
  plan.once = true;
  return plan;
}

std::string lines_of(const std::vector<SweepRow>& rows) {
  std::string lines;
  for (const SweepRow& row : rows) lines += to_line(row);
  return lines;
}

// Blocks end with a sample, and where cases are missing that an earlier process has finished.
TEST(Blocks, HoldNeighboursOfOneSampleWhereThePlanIdentifiesOnce) {
  const SweepPlan plan = plan_with({"beam.length_m=1,2"}, 1, 20);
  std::vector<std::size_t> left(40);
  std::iota(left.begin(), left.end(), std::size_t{0});
  EXPECT_EQ(blocks_of(plan, left).size(), 40u);
  std::vector<std::size_t> sizes;
  for (const CaseBlock& block : blocks_of(once(plan), left)) sizes.push_back(block.size());
  EXPECT_THAT(sizes, ElementsAre(16u, 4u, 16u, 4u));
  EXPECT_EQ(CaseQueue(blocks_of(once(plan), {3, 7, 19, 20, 39})).cases(), 5u);
}

// Oracle: every case by itself.
TEST(Repeats, AreTheSameBytesInWhateverBlock) {
  const SweepSource source{{"rig.toml", test::exact_rig}, {}, {}};
  const SweepPlan plan = once(plan_with({"sensors[1].noise_m=0.0003,0.01"}, 1, 7));
  Repeats together(source, plan), apart(source, plan);
  for (const CaseBlock& block : {CaseBlock{0, 1, 2, 3, 4, 5, 6}, CaseBlock{7, 8, 10, 13}}) {
    std::string alone;
    for (const std::size_t number : block) alone += lines_of(apart.run({number}));
    EXPECT_EQ(lines_of(together.run(block)), alone);
  }
}

// Oracle: the registered filter, one record after another; on_failure = "report" keeps it out of the lanes.
TEST(Repeats, GiveWhatTheFilterGivesEachRecord) {
  const SweepPlan plan = once(plan_with({}, 1, 6));
  const CaseBlock block{0, 1, 2, 3, 4, 5};
  for (const std::string scheme : {"exponential", "forward_euler"}) {
    const std::string chosen = test::exact_rig + ("[filter]\ndiscretisation = \"" + scheme + "\"\n");
    const SweepSource source{{"rig.toml", chosen}, {}, {}},
        registered{{"rig.toml", chosen + "on_failure = \"report\"\n"}, {}, {}};
    const auto lanes = Repeats(source, plan).run(block), alone = Repeats(registered, plan).run(block);
    ASSERT_EQ(lanes.size(), 12u) << lanes[0].reason;
    ASSERT_EQ(alone.size(), 12u) << alone[0].reason;
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      EXPECT_EQ(lanes[i].discretisation, scheme);
      EXPECT_EQ(lanes[i].status, alone[i].status) << lanes[i].reason << alone[i].reason;
      EXPECT_EQ(lanes[i].bound, alone[i].bound);
      EXPECT_NEAR(lanes[i].estimate, alone[i].estimate, 1e-8 * alone[i].deviation);
      EXPECT_NEAR(lanes[i].deviation, alone[i].deviation, 1e-8 * alone[i].deviation);
    }
  }
}

// Oracle: the Cramer-Rao bound, and the filter's own promise; bands as above. A stiffness believed to 5 % is
// near enough for a single pass.
TEST(Repeats, AreAsNearToTheTruthAsTheBoundSays) {
  const std::string doubt = "[[parameters]]\nquantity = \"stiffness\"\nrelative_deviation = 0.05\n";
  const SweepSource source{{"rig.toml", test::exact_rig + doubt}, {}, {}};
  const auto rows = perform(source, once(plan_with({}, 1, 200)), {}, [](const std::string&) {});
  for (const PointStatistics& one : statistics(plan_with({}, 1, 200), rows)) {
    EXPECT_EQ(one.converged, 200) << one.parameter;
    EXPECT_NEAR(one.rms_over_bound, 1.0, 3.5 / std::sqrt(2.0 * 200)) << one.parameter;
    EXPECT_GE(one.coverage.value(), 0.905) << one.parameter;
  }
}

// Oracle: the finding. Explicit Euler steps turn C into C + K dt, to first order in the damping; K is kept.
TEST(Repeats, ByForwardEulerMissTheDampingAsTheClosedFormSays) {
  std::string rig = test::exact_rig;
  const std::string slow = "duration_s = 4\nsampling_rate_hz = 40\n";
  rig.replace(rig.find(slow), slow.size(), "duration_s = 10\nsampling_rate_hz = 1000\nmodes = 1\n");
  rig += "[filter]\ndiscretisation = \"forward_euler\"\n";
  const SweepPlan plan = once(plan_with({}, 1, 8));
  const auto rows = perform({{"rig.toml", rig}, {}, {}}, plan, {}, [](const std::string&) {});
  const auto all = statistics(plan, rows);
  ASSERT_EQ(all.size(), 2u);
  const double stiffness = rows[0].truth;
  EXPECT_NEAR(all[0].bias_percent, 0.0, 0.1);
  EXPECT_NEAR(all[1].bias, 1e-3 * stiffness, 0.01 * 1e-3 * stiffness);
}

TEST(Repeats, SayWhatTheyCannotTake) {
  const std::string modal = std::string(test::exact_rig) + "[model]\nname = \"modal\"\n";
  const auto rows = Repeats({{"rig.toml", modal}, {}, {}}, once(plan_with({}))).run({0});
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].status, "failed");
  EXPECT_THAT(rows[0].reason, HasSubstr("takes model sdof and one reduction; found model modal"));
}

TEST(Repeats, RefuseReadingsThatALoggerHasChanged) {
  const std::string jittered = std::string(test::exact_rig) + "[acquisition]\njitter = 0.1\n";
  const auto rows = Repeats({{"rig.toml", jittered}, {}, {}}, once(plan_with({}))).run({0});
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].status, "failed");
  EXPECT_THAT(rows[0].reason, HasSubstr("takes records of perfect instruments"));
}

// Oracle: the beam simulated.
TEST(Sweep, SimulatesWhatSensorsAndLoggerDo) {
  const std::string coarse = std::string(test::exact_rig) + "[acquisition]\njitter = 0.2\nrepeated = 0.02\n";
  const SweepPlan plan = plan_with({}, 1, 1);
  const auto perfect = run_case({{"rig.toml", test::exact_rig}, {}, {}}, plan, 0),
             logged = run_case({{"rig.toml", coarse}, {}, {}}, plan, 0);
  ASSERT_EQ(logged.size(), perfect.size());
  for (std::size_t i = 0; i < logged.size(); ++i) {
    EXPECT_EQ(logged[i].status, "converged") << logged[i].reason;
    EXPECT_NE(logged[i].estimate, perfect[i].estimate);
    EXPECT_LT(std::abs(logged[i].error), 5.0 * logged[i].deviation) << logged[i].parameter;
  }
}

TEST(Sweep, ReachesTablesWithinTablesAndTheTruthAlone) {
  const SweepPlan plan =
      plan_with({"sensors[1].noise_m=0.001,0.002", "truth.beam.tip_mass_kg=0.4", "beam.elements=12"});
  const SweepSource source{{"rig.toml", test::exact_rig}, {}, {}};
  const Experiment believed = experiment_of(source, plan, 1), truth = experiment_of(source, plan, 1, true);
  EXPECT_EQ(believed.sensors[0].noise, 0.002);
  EXPECT_EQ(believed.elements, 12);
  EXPECT_EQ(believed.structure.beam().tip_mass(), 0.36);
  EXPECT_EQ(truth.structure.beam().tip_mass(), 0.4);
  EXPECT_EQ(truth.simulation.seed, 2u);
  EXPECT_THAT([&] { experiment_of(source, plan_with({"sensors[2].noise_m=1"}), 0); },
              ThrowsMessage<InputError>(HasSubstr("there is no sensors[2]; sensors has 1 tables")));
}

}  // namespace
}  // namespace beamid::experiments::sweep_test
