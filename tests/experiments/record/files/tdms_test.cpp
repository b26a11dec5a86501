// TDMS files of National Instruments: what is read, what is refused.
// Oracles: the numbers written into the files, by hand from the description of the format [tdms]; for scales,
// polynomials evaluated here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "experiments/record/read_record.hpp"
#include "experiments/record/record_table.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/record/files/damaged_file.hpp"
#include "tests/experiments/record/files/written_record.hpp"
#include "tests/experiments/record/files/written_tdms.hpp"

namespace beamid::experiments::tdms_test {
namespace {

using testing::AllOf, testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;

Record record_of(const std::string& bytes) {
  const TemporaryFile file("test.tdms", bytes);
  return read_record(file.path());
}

RecordTable table_of(const std::string& bytes) {
  const TemporaryFile file("test.tdms", bytes);
  return read_table(file.path(), {});
}

std::string error_of(const std::string& bytes) {
  const TemporaryFile file("test.tdms", bytes);
  return input_error_of(file, [&] { read_record(file.path()); });
}

TEST(TdmsReader, ReadsChannelsUnitsAndTheIntervalInEitherByteOrder) {
  for (const bool big : {false, true}) {
    const std::string bytes = contiguous(Writer{big}, 0, written_samples);
    const Record record = record_of(bytes);
    expect_both(record, 1e-13);
    EXPECT_EQ(record.channels[0].name, "Tip");
    EXPECT_THAT(record.remarks, IsEmpty());
    const TemporaryFile file("test.tdms", bytes);
    EXPECT_EQ(reader_of(file.path(), {}), "tdms");
  }
}

// Of the description of the format: a segment without metadata repeats the one before, chunks are appended
// without a segment, an index of 0 is the one before.
TEST(TdmsReader, JoinsSegmentsAndChunks) {
  const Writer write;
  const std::string same =
      write.objects({write.object(tip, write.u32(as_before)), write.object(hammer, write.u32(as_before))});
  const auto ten = [&](int from) {
    return values_of<double>(write, first_signal, from, from + 10) +
           values_of<double>(write, second_signal, from, from + 10);
  };
  expect_both(record_of(contiguous(write, 0, 10) + contiguous(write, 10, 20, false) +
                        write.segment(usual, same, ten(20) + ten(30))),
              1e-13);
}

// Oracle: the example of five segments in the description of the format, the lengths in its lead-ins among
// it.
TEST(TdmsReader, FollowsTheExampleOfTheFormat) {
  const Writer write;
  const auto channel = [&](const char* name, const std::string& index, const std::string& property = "") {
    return write.object(
        name, index, property.empty() ? std::vector<std::string>() : std::vector{write.is("prop", property)});
  };
  const auto numbers = [&](std::int32_t from, std::int32_t to) {
    std::string bytes;
    for (std::int32_t k = from; k <= to; ++k) bytes += write.number(k);
    return bytes;
  };
  const char *const one = "/'group'/'channel1'", *const two = "/'group'/'channel2'",
                    *const three = "/'group'/'voltage'";
  const std::string three_each = numbers(1, 3) + numbers(4, 6), same = write.u32(as_before);
  const std::vector<std::string> segments{
      write.segment(
          usual,
          write.objects({channel(one, write.index(int32, 3), "valid"), channel(two, write.index(int32, 3))}),
          three_each + three_each),
      write.segment(metadata | raw, write.objects({channel(one, same, "error")}), three_each),
      write.segment(metadata | raw, write.objects({channel(three, write.index(int32, 5))}),
                    three_each + numbers(7, 11)),
      write.segment(metadata | raw, write.objects({channel(two, write.index(int32, 27))}),
                    numbers(1, 3) + numbers(1, 27) + numbers(7, 11)),
      write.segment(usual, write.objects({channel(one, same), channel(three, same)}),
                    numbers(1, 3) + numbers(7, 11))};
  std::string bytes;
  std::vector<std::size_t> lengths;
  for (const std::string& segment : segments) bytes += segment, lengths.push_back(segment.size() - 28);
  EXPECT_THAT(lengths, ElementsAre(0xA7, 0x50, 0x5E, 0xBF, 0x61));
  const RecordTable table = table_of(bytes);
  EXPECT_THAT(table.remarks, ElementsAre("Omitted, as not of 39 samples: channel1 (18), voltage (15)."));
  std::vector<double> expected;
  for (int k = 0; k < 12; ++k) expected.push_back(4 + k % 3);
  for (int k = 1; k <= 27; ++k) expected.push_back(k);
  EXPECT_THAT(table.columns, ElementsAre(expected));
}

// A list without the flag of a new one adds to the channels before, in order.
TEST(TdmsReader, AddsChannelsToTheListAndTakesThemAway) {
  const Writer write;
  const std::string acceleration = write.object(tip, write.index(float64, 20), in_g(write)),
                    force = write.object(hammer, write.index(float64, 40), in_newton(write)),
                    no_force = write.object(hammer, write.u32(none));
  const std::string first = values_of<double>(write, first_signal, 0, 20),
                    rest = values_of<double>(write, first_signal, 20, 40),
                    all = values_of<double>(write, second_signal, 0, 40);
  expect_both(record_of(write.segment(usual, write.objects({acceleration}), first) +
                        write.segment(metadata | raw, write.objects({force}), rest + all)),
              1e-13);
  expect_both(record_of(write.segment(usual, write.objects({acceleration, force}), first + all) +
                        write.segment(metadata | raw, write.objects({no_force}), rest)),
              1e-13);
}

std::vector<std::string> linear(const Writer& write, int scale, double slope, double intercept,
                                std::uint32_t source) {
  const std::string key = "NI_Scale[" + std::to_string(scale) + "]_";
  return {write.is(key + "Scale_Type", "Linear"), write.is(key + "Linear_Slope", slope),
          write.is(key + "Linear_Y_Intercept", intercept), write.is(key + "Linear_Input_Source", source)};
}

std::vector<std::string> joined(std::vector<std::string> one, const std::vector<std::string>& other) {
  one.insert(one.end(), other.begin(), other.end());
  return one;
}

TEST(TdmsReader, ScalesInterleavedIntegers) {
  for (const bool big : {false, true}) {
    const Writer write{big};
    const auto unscaled = [&](const std::vector<std::string>& properties, double slope, double intercept) {
      return joined(joined(properties, linear(write, 0, slope, intercept, none)),
                    {write.is("NI_Number_Of_Scales", 1U), write.is("NI_Scaling_Status", "unscaled")});
    };
    std::string rows;
    for (int k = 0; k < written_samples; ++k)
      rows += write.number(static_cast<std::int16_t>(std::lround((first_signal(k) - 0.25) / 1e-4))) +
              write.number(static_cast<std::int32_t>(std::lround(second_signal(k) / 1e-6)));
    // The count is that of half the rows: they are read to the end of the segment.
    const std::string bytes = write.segment(
        usual | interleaved,
        write.objects({write.object(tip, write.index(int16, 20), unscaled(in_g(write), 1e-4, 0.25)),
                       write.object(hammer, write.index(int32, 20), unscaled(in_newton(write), 1e-6, 0.0))}),
        rows);
    const Record record = record_of(bytes);
    expect_both(record, 0.5e-4);
    EXPECT_THAT(record.remarks, ElementsAre("Scaled as the file states: 'Tip', 'Hammer'."));
  }
}

// Oracle: y = 1 + 2 (3 x - 1) - 0.5 (3 x - 1)^2, of a chain in which the last scale takes in the first.
TEST(TdmsReader, AppliesPolynomialsAndChainsOfScales) {
  const Writer write;
  const std::vector<std::string> chain =
      joined(linear(write, 0, 3.0, -1.0, none), {write.is("NI_Scale[1]_Scale_Type", "Polynomial"),
                                                 write.is("NI_Scale[1]_Polynomial_Input_Source", 0U),
                                                 write.is("NI_Scale[1]_Polynomial_Coefficients_Size", 3U),
                                                 write.is("NI_Scale[1]_Polynomial_Coefficients[0]", 1.0),
                                                 write.is("NI_Scale[1]_Polynomial_Coefficients[1]", 2.0),
                                                 write.is("NI_Scale[1]_Polynomial_Coefficients[2]", -0.5)});
  const auto expected = [](int k) {
    const double x = 3.0 * first_signal(k) - 1.0;
    return 1.0 + 2.0 * x - 0.5 * x * x;
  };
  const RecordTable scaled = table_of(single(chain));
  const RecordTable done = table_of(single(joined(chain, {write.is("NI_Scaling_Status", "scaled")})));
  // The scales of the group hold for a channel that has none.
  const RecordTable by_group =
      table_of(write.segment(usual,
                             write.objects({write.object("/'Run 1'", write.u32(none), chain),
                                            write.object(tip, write.index(float64, written_samples))}),
                             values_of<double>(write, first_signal, 0, written_samples)));
  for (std::size_t k = 0; k < written_samples; ++k) {
    EXPECT_DOUBLE_EQ(scaled.columns[0][k], expected(static_cast<int>(k)));
    EXPECT_DOUBLE_EQ(by_group.columns[0][k], expected(static_cast<int>(k)));
    EXPECT_DOUBLE_EQ(done.columns[0][k], first_signal(static_cast<int>(k)));
  }
}

// What cannot be scaled is not shown in its stored values; the other channels are read.
TEST(TdmsReader, OmitsChannelsThatAreNoNumbersOrHaveOtherScales) {
  const Writer write;
  const std::vector<std::string> thermocouple{write.is("NI_Number_Of_Scales", 1U),
                                              write.is("NI_Scale[0]_Scale_Type", "Thermocouple")};
  const std::string words = "onetwo", offsets = write.u32(3) + write.u32(6);
  const std::string bytes = write.segment(
      usual,
      write.objects({write.object("/'Run 1'/'Notes'", write.u32(28) + write.u32(text_type) + write.u32(1) +
                                                          write.u64(2) + write.u64(offsets.size() + 6)),
                     write.object("/'Run 1'/'Oven'", write.index(float32, 40), thermocouple),
                     write.object(tip, write.index(float64, 40), in_g(write)),
                     write.object(hammer, write.index(float64, 40), in_newton(write))}),
      offsets + words + values_of<float>(write, first_signal, 0, 40) +
          values_of<double>(write, first_signal, 0, 40) + values_of<double>(write, second_signal, 0, 40));
  const Record record = record_of(bytes);
  expect_both(record, 1e-13);
  EXPECT_THAT(record.remarks, ElementsAre("Omitted: 'Notes' (text), 'Oven' (a scale of type Thermocouple)."));
  EXPECT_THAT(error_of(single(thermocouple)),
              HasSubstr("no channel of two numbers: omitted are 'Tip' (a scale of type Thermocouple)"));
  // Scales that take each other in, numbers that are absent, a status of another kind.
  EXPECT_THAT(error_of(single(linear(write, 0, 2.0, 0.0, 0))), HasSubstr("(a scale of type Linear)"));
  EXPECT_THAT(error_of(single({write.is("NI_Scale[0]_Scale_Type", "Linear")})), HasSubstr("of type Linear"));
  EXPECT_THAT(error_of(single({write.is("NI_Number_Of_Scales", 2U)})), HasSubstr("(no scale 1)"));
  EXPECT_THAT(
      error_of(single(joined(linear(write, 0, 2.0, 0.0, none), {write.is("NI_Scaling_Status", "half")}))),
      HasSubstr("the status 'half' of its scales"));
  EXPECT_THAT(error_of(single({write.is("NI_Scaling_Status", "unscaled")})),
              HasSubstr("unscaled, without a scale"));
  EXPECT_THAT(
      error_of(single(joined(linear(write, 1, 2.0, 0.0, none), {write.is("NI_Number_Of_Scales", 1U)}))),
      HasSubstr("more scales than NI_Number_Of_Scales"));
}

// Oracle: as many rows as are whole. A closed file of the same bytes is refused.
TEST(TdmsReader, ReadsFilesThatWereNotClosed) {
  const Writer write;
  expect_both(record_of(contiguous(write, 0, 20) + contiguous(write, 20, 40, false, false)), 1e-13);
  const std::string torn = values_of<double>(write, first_signal, 40, 43);
  const Record record = record_of(contiguous(write, 0, 20) + contiguous(write, 20, 40, false, false) + torn);
  expect_both(record, 1e-13);
  EXPECT_THAT(texts(record.objections),
              ElementsAre("The file was not closed: its last 24 bytes, of unfinished samples, are omitted."));
  EXPECT_THAT(error_of(contiguous(write, 0, 20, true, false) + contiguous(write, 20, 40)),
              HasSubstr("a segment without an end, and another one at byte"));
  // The last segment ends in its description: those before it are read.
  const std::string begun = contiguous(write, 20, 40, true, false).substr(0, 60);
  expect_both(record_of(contiguous(write, 0, 40) + begun), 1e-13);
  EXPECT_THAT(error_of(write.segment(usual,
                                     write.objects({write.object(tip, write.index(float64, 20)),
                                                    write.object(hammer, write.index(float64, 20))}),
                                     values_of<double>(write, first_signal, 0, 21))),
              HasSubstr("168 bytes of raw data at byte 119 in chunks of 320; expected whole chunks"));
}

// The rows of a converter hold its channels at stated places; a second converter has a buffer of its own.
TEST(TdmsReader, ReadsTheBuffersOfDaqmx) {
  const Writer write;
  const auto scaled = [&](const std::vector<std::string>& properties, double slope) {
    return joined(joined(properties, linear(write, 1, slope, 0.0, 0)),
                  {write.is("NI_Number_Of_Scales", 2U), write.is("NI_Scaling_Status", "unscaled")});
  };
  constexpr std::uint32_t daqmx_int16 = 3, daqmx_int32 = 5;
  const auto objects = [&](const std::vector<std::uint32_t>& widths, std::uint32_t within,
                           std::uint32_t buffer) {
    return write.objects(
        {write.object(tip, write.daqmx_index(daqmx_int16, 20, 2, widths), scaled(in_g(write), 1e-4)),
         write.object(hammer, write.daqmx_index(daqmx_int32, 20, within, widths, buffer),
                      scaled(in_newton(write), 1e-6))});
  };
  const auto acceleration = [&](int k) {
    return write.number(std::int16_t{7}) + values_of<std::int16_t>(write, first_signal, k, k + 1, 1e-4);
  };
  const auto force = [&](int k) { return values_of<std::int32_t>(write, second_signal, k, k + 1, 1e-6); };
  std::string one, two;
  for (int k = 0; k < written_samples; ++k) one += acceleration(k) + force(k);
  for (const int from : {0, 20}) {
    for (int k = from; k < from + 20; ++k) two += acceleration(k);
    for (int k = from; k < from + 20; ++k) two += force(k);
  }
  expect_both(record_of(write.segment(usual | daqmx | interleaved, objects({8}, 4, 0), one)), 0.5e-4);
  expect_both(record_of(write.segment(usual | daqmx | interleaved, objects({4, 4}, 0, 1), two)), 0.5e-4);
  EXPECT_THAT(error_of(write.segment(usual | daqmx, objects({8}, 6, 0), one)),
              HasSubstr("'Hammer' is outside its buffer of DAQmx"));
  EXPECT_THAT(error_of(write.segment(usual | daqmx, objects({8}, 4, 1), one)),
              HasSubstr("outside its buffer"));
}

TEST(TdmsReader, RefusesWhatHasAnUncertainPlaceInTheFile) {
  const Writer write;
  const auto of_type = [&](const std::string& index) {
    return write.segment(usual, write.objects({write.object(tip, index)}), std::string(320, '\1'));
  };
  EXPECT_THAT(error_of(of_type(write.u32(0x1369) + write.u32(none))),
              AllOf(HasSubstr("DAQmx's digital lines"), HasSubstr("exported by LabVIEW or DIAdem")));
  EXPECT_THAT(error_of(of_type(write.index(0x0B, 20))),
              HasSubstr("extended precision, type 0xb; expected integers, single or double precision"));
  EXPECT_THAT(error_of(of_type(write.index(0x4F, 20))), HasSubstr("of type 0x4f"));
  EXPECT_THAT(error_of(of_type(write.u32(as_before))), HasSubstr("raw data as before, and has had none"));
  EXPECT_THAT(error_of(of_type(write.index(float64, 0))), HasSubstr("320 bytes of raw data of no channel"));
  EXPECT_THAT(error_of(write.segment(raw, "", "values")), HasSubstr("6 bytes of raw data of no channel"));
  // Counts that no file holds.
  for (const std::uint64_t huge : {endless, endless / 2, std::uint64_t{1} << 61, std::uint64_t{1} << 40}) {
    EXPECT_THAT(error_of(write.segment(usual,
                                       write.objects({write.object(tip, write.index(float64, huge)),
                                                      write.object(hammer, write.index(float64, huge))}),
                                       std::string(320, '\1'))),
                HasSubstr("expected whole chunks"));
    EXPECT_THAT(
        error_of(write.segment(
            usual, write.objects({write.object(tip, write.daqmx_index(3, huge, 0, {none, none}))}), "1")),
        HasSubstr("expected whole chunks"));
  }
}

TEST(TdmsReader, NamesFilesThatAreCutShort) {
  const Writer write;
  const std::string whole = contiguous(write, 0, 20) + contiguous(write, 20, 40, false);
  EXPECT_THAT(error_of(whole.substr(0, whole.size() - 1)),
              HasSubstr("a segment of 319 bytes at byte " + std::to_string(whole.size() - 320) +
                        "; expected 320, as its lead-in states"));
  for (std::size_t length = 4; length < whole.size(); length += 5)
    if (length != whole.size() - 348) {  // where the second segment begins
      EXPECT_THAT(error_of(whole.substr(0, length)), HasSubstr("expected ")) << length;
    }
  EXPECT_THAT(error_of("TDSh" + whole.substr(4)), HasSubstr("expected the .tdms file beside it"));
  EXPECT_THAT(error_of(whole + "remainder"), HasSubstr("9 bytes that are no segment of TDMS"));
}

TEST(TdmsReader, TakesTheRateAndTheStartFromProperties) {
  const Writer write;
  const auto clock = [&](const std::vector<std::string>& properties) {
    const RecordTable table = table_of(single(properties));
    return table.clock ? std::pair(table.clock->start, table.clock->interval) : std::pair(0.0, 0.0);
  };
  EXPECT_EQ(clock({write.is("wf_increment", 0.004), write.is("wf_start_offset", -0.5)}),
            std::pair(-0.5, 0.004));
  EXPECT_EQ(clock({write.is("wf_increment", 4.0), write.is("wf_xunit_string", "ms")}), std::pair(0.0, 0.004));
  EXPECT_EQ(clock({write.is("wf_increment", 0.0), write.is("SampleRate", 250.0)}), std::pair(0.0, 0.004));
  EXPECT_EQ(clock({write.is("wf_increment", 0.0)}), std::pair(0.0, 0.0));
  EXPECT_THAT(error_of(single({write.is("wf_increment", 0.5), write.is("wf_xunit_string", "Hz")})),
              HasSubstr("the abscissa of 'Tip'"));
}

// Channels of other lengths may have another rate; those that make the record may not.
TEST(TdmsReader, KeepsChannelsOfOneRate) {
  const Writer write;
  const auto both = [&](int samples, double interval) {
    const std::string other = "/'Run 1'/'Slow'";
    return contiguous(write, 0, written_samples) +
           write.segment(
               usual,
               write.objects({write.object(other, write.index(float64, static_cast<std::uint64_t>(samples)),
                                           {write.is("wf_increment", interval)})}),
               values_of<double>(write, first_signal, 0, samples));
  };
  const Record record = record_of(both(10, 0.04));
  expect_both(record, 1e-13);
  EXPECT_THAT(record.remarks, ElementsAre("Omitted, as not of 40 samples: Slow (10)."));
  EXPECT_THAT(error_of(both(40, 0.04)),
              HasSubstr("'Tip' at intervals of 0.01 s and 'Slow' of 0.04 s, both of 40 samples"));
}

std::string resumed(std::int64_t start, double part, double interval) {
  const Writer write;
  return contiguous(write, 0, 20) +
         write.segment(
             metadata | raw,
             write.objects({write.object(tip, write.u32(as_before),
                                         {write.starts(start, part), write.is("wf_increment", interval)})}),
             values_of<double>(write, first_signal, 20, 40) +
                 values_of<double>(write, second_signal, 20, 40));
}

// Appended runs have no gap in the file: only their stamps show it.
TEST(TdmsReader, WarnsOfRunsThatDoNotFollowEachOther) {
  const Writer write;
  const std::string first = write.segment(
      metadata | new_list,
      write.objects({write.object(tip, write.u32(none), {write.starts(3'700'000'000, 0.5)})}), "");
  const auto warnings = [&](std::int64_t start, double part) {
    return texts(record_of(first + resumed(start, part, 0.01)).objections);
  };
  EXPECT_THAT(warnings(3'700'000'000, 0.7), IsEmpty());
  EXPECT_THAT(
      warnings(3'700'000'060, 0.7),
      ElementsAre("'Tip' is 60 s behind its place in the record from sample 21 on, by wf_start_time and "
                  "wf_start_offset."));
  EXPECT_THAT(error_of(first + resumed(3'700'000'000, 0.7, 0.02)),
              HasSubstr("wf_increment of /'Run 1'/'Tip' changes from 0.01 to 0.02; expected one rate"));
}

// A double since 1904 resolves half a microsecond: stamps are those of the first second.
TEST(TdmsReader, TakesStampsForTimes) {
  for (const bool big : {false, true}) {
    const Writer write{big};
    std::string stamps;
    for (int k = 0; k < written_samples; ++k)
      stamps += write.stamp(3'700'000'000 + (90 + k) / 100, ((90 + k) % 100) / 100.0);
    const RecordTable table = table_of(write.segment(
        usual,
        write.objects({write.object("/'Run 1'/'Time'", write.index(stamp_type, written_samples)),
                       write.object(tip, write.index(float64, written_samples), {in_g(write)[0]})}),
        stamps + values_of<double>(write, first_signal, 0, written_samples)));
    ASSERT_EQ(table.time, 0u);
    for (int k = 0; k < written_samples; ++k)
      EXPECT_NEAR(table.columns[0][static_cast<std::size_t>(k)], 0.9 + 0.01 * k, 1e-12);
  }
}

TEST(TdmsReader, NamesChannelsWithTheirGroupsWhereSeveralHoldData) {
  const Writer write;
  EXPECT_THAT(table_of(single({}, 40, "/'Dr. T''s'/'it''s'")).names, ElementsAre("it's"));
  EXPECT_THAT(table_of(single({}) + single({}, 40, "/'Dr. T''s'/'Tip'")).names,
              ElementsAre("Run 1/Tip", "Dr. T's/Tip"));
}

TEST(TdmsReader, ReadsOrRefusesDamagedFiles) {
  const Writer write;
  expect_read_or_refused("fuzz.tdms", contiguous(write, 0, 20) + contiguous(write, 20, 40, false, false), {},
                         1, 300);
  expect_read_or_refused("fuzz.tdms", resumed(3'700'000'000, 0.7, 0.01), {}, 2, 300);
  const std::string rows = values_of<std::int16_t>(write, first_signal, 0, 40, 1e-4);
  expect_read_or_refused(
      "fuzz.tdms",
      write.segment(usual | daqmx,
                    write.objects({write.object(tip, write.daqmx_index(3, 20, 0, {2}),
                                                joined(in_g(write), linear(write, 1, 1e-4, 0.0, 0)))}),
                    rows),
      {}, 3, 300);
}

}  // namespace
}  // namespace beamid::experiments::tdms_test
