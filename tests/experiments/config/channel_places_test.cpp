// Oracles: positions as they were given; a file written and read back.
#include "experiments/config/experiment.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "experiments/config/read_experiment.hpp"
#include "experiments/record/read_record.hpp"
#include "experiments/record/record.hpp"
#include "experiments/results/result_directory.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::channel_places_test {
namespace {

using testing::HasSubstr, testing::ThrowsMessage;

Experiment cantilever(const std::string& sensors) {
  return read_experiment(TomlTable::parse(
      "[beam]\nlength_m = 1.1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = 2.12e11\nmass_kg = 3\n" +
          sensors,
      "test.toml"));
}

const std::string tip_and_mid =
    "[[sensors]]\nname = \"end\"\nposition_m = 1.1\n"
    "[[sensors]]\nname = \"Mid span\"\nposition_m = 0.55\n";

Record record_of(const std::vector<Channel>& channels) {
  Record record;
  record.time = Eigen::VectorXd::LinSpaced(20, 0.0, 0.019);
  record.samples = Eigen::MatrixXd::Ones(static_cast<Eigen::Index>(channels.size()), 20);
  record.channels = channels;
  return record;
}

double place(const Record& record, std::size_t i) {
  return record.channels[i].position.value_or(-1.0);
}

TEST(ChannelPlaces, AreThoseOfTheSensorsOfTheSameName) {
  const Record placed =
      with_places(record_of({{Quantity::acceleration, "mid_span"}, {Quantity::acceleration, "end"}}),
                  cantilever(tip_and_mid));
  EXPECT_EQ(place(placed, 0), 0.55);
  EXPECT_EQ(place(placed, 1), 1.1);
  EXPECT_EQ(channels_text(placed), "mid_span: acceleration at 0.55 m, end: acceleration at 1.1 m");
}

TEST(ChannelPlaces, StandInTheNamesOfSimulatedRecords) {
  const Record placed = with_places(record_of({{Quantity::acceleration, "x0_25m"},
                                               {Quantity::acceleration, "tip"},
                                               {Quantity::acceleration, "tip_2"}}),
                                    cantilever(""));
  EXPECT_EQ(place(placed, 0), 0.25);
  EXPECT_EQ(place(placed, 1), 1.1);
  EXPECT_EQ(place(placed, 2), 1.1);
}

TEST(ChannelPlaces, AreTheNaturalPointOnlyWhereThatIsNoGuess) {
  const Record one = with_places(
      record_of({{Quantity::acceleration, "ai0"}, {Quantity::displacement, "laser"}}), cantilever(""));
  EXPECT_EQ(place(one, 0), 1.1);
  EXPECT_EQ(place(one, 1), 1.1);
  const auto refused = [](const std::vector<Channel>& channels, const std::string& sensors,
                          const char* text) {
    EXPECT_THAT([&] { with_places(record_of(channels), cantilever(sensors)); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(text)));
  };
  refused({{Quantity::acceleration, "ai0"}, {Quantity::acceleration, "ai1"}}, "", "where channel 'ai0'");
  refused({{Quantity::acceleration, "ai0"}}, tip_and_mid, "the file names end, Mid span");
  refused({{Quantity::strain, "gauge"}}, "", "distance_m");
}

TEST(ChannelPlaces, TravelWithARecordInTheFileBesideIt) {
  const TemporaryFile file("places.csv", "");
  const std::filesystem::path csv = file.path();
  Record record = record_of({{Quantity::acceleration, "first", 0.275}, {Quantity::force, "hammer", 0.55}});
  record.input_path = InputPath::linear;
  write_record(record, csv);
  write_file(places_file(csv), places_text(record, csv.filename().string()));
  const Record back = read_record(csv);
  EXPECT_EQ(place(back, 0), 0.275);
  EXPECT_EQ(place(back, 1), 0.55);
  EXPECT_EQ(back.input_path, InputPath::linear);
  // What an experiment file says of a column holds.
  RecordFormat format;
  format.channels = {{Quantity::acceleration, "acceleration_first_m_per_s2"}};
  format.channels[0].position = 1.1;
  EXPECT_EQ(place(read_record(csv, format), 0), 1.1);
  // Another record's file is left alone.
  write_file(places_file(csv), places_text(record, "other.csv"));
  EXPECT_EQ(place(read_record(csv), 0), -1.0);
  std::filesystem::remove(places_file(csv));
}

}  // namespace
}  // namespace beamid::experiments::channel_places_test
