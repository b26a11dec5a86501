// Which columns of a file hold a record's time and channels.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/record/recognised_column.hpp"
#include "experiments/record/record.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/record/units.hpp"

namespace beamid::experiments {

struct RecordColumn {
  std::size_t index = 0;  ///< from 0
  double factor = 1;      ///< to SI units
  Channel channel;        ///< of no meaning for time
  bool assumed = false;   ///< no name or unit states its quantity
};

struct RecordColumns {
  std::optional<RecordColumn> time;
  std::vector<RecordColumn> channels;
  bool recognised = false;                  ///< channels by names as people write them, or without any
  std::optional<std::size_t> counted = {};  ///< a column that counts samples, where there are no stamps
};

/// What a column's name says ("acceleration_g"), or the unit that the file gives it.
/// @throws InputError at the header where they contradict each other.
std::optional<ColumnMeaning> stated_meaning(const RecordTable& table, std::size_t index);

/// Empty where the file gives none.
std::string column_name_of(const RecordTable& table, std::size_t index);

/// What its name and its unit say of a column, as people write them.
std::optional<RecognisedColumn> recognised(const RecordTable& table, std::size_t index);

/// Where the configuration states what no file does, for messages.
inline constexpr const char* in_configuration =
    "--column N --quantity acceleration --unit g, or record.channels in the configuration";

// Columns of a file that nobody described (columns_of_header.cpp).

/// Times and channels by the names of the columns, or without any by their numbers; what was recognised is a
/// remark.
/// @param stamped whether times are stated elsewhere
/// @throws InputError at the header, with the one question that is left
RecordColumns columns_of_header(RecordTable& table, bool stamped);

/// Times alone, where channels are stated. @throws InputError likewise.
void find_times(RecordTable& table, RecordColumns& columns);

/// Whether some column is named for what moves: others, of neither quantity nor unit, are something else.
bool names_motion(const RecordTable& table);

/// Whether a step of times, in units of `taken` [s], is that of a rate of 10 Hz to 200 kHz.
bool is_plausible(double step, double taken);

/// Times of no stated unit whose rate would be another, were they in units of `taken` [s]: most are in
/// another unit. @throws InputError the question
void require_plausible_step(const RecordTable& table, std::size_t index, double taken);

/// Two columns of times, each for the channels beside it.
/// @param time that is taken; @param is_sure whether its unit is stated; @param index of the other
/// @throws InputError where they run at different rates, whatever their units, or over different rows
void require_one_clock(const RecordTable& table, const RecordColumn& time, bool is_sure, std::size_t index,
                       const RecognisedColumn& other);

/// The column that a description names. @throws InputError at the header or the first row.
std::size_t find_index(const RecordTable& table, const ColumnDescription& wanted);

/// Finds the columns a format names, or, where it names none, those that the file describes itself. In a file
/// with units those whose unit says nothing are left out, with a remark.
/// @throws InputError at the header or the first row.
RecordColumns find_columns(RecordTable& table, const RecordFormat& format);

/// Rows that a logger wrote twice, and rows of an uneven clock that share the stamp of the row before.
void leave_out_repeated(RecordTable& table, const RecordColumns& columns);

/// One row of each few where every channel repeats its readings over as many, as where a logger writes a row
/// for each of its sensors: what is repeated would be images of the modes.
void keep_updates(RecordTable& table, const RecordColumns& columns);

/// Likewise magnitudes of other columns, which have no frequency of their own.
void leave_out_magnitudes(RecordTable& table, RecordColumns& columns);

/// Of a file that nobody described: an axis that is not connected is no channel, unless no other moves
/// either. A column that no name or unit describes and that shows pulses to one side but no vibration, while
/// another vibrates for ten times as long, is a hammer's force and no response. Each is left out with a
/// remark in `table`.
void leave_out_still(RecordTable& table, RecordColumns& columns);

/// What is stated of a column holds, also where its header is wrong; but a column taken for its neighbour, or
/// for another unit, makes every result wrong without a sign: a warning in `table`.
void compare_with_header(const ColumnDescription& wanted, std::size_t index, RecordTable& table);

}  // namespace beamid::experiments
