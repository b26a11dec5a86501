// Files that only a library can read, read where its faults do no harm.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/SparseCore>

#include "experiments/record/record.hpp"
#include "experiments/record/record_table.hpp"

namespace beamid::experiments {

// Signals found under names in a binary file, made one table.

/// Takes whatever numbers a file holds and makes a table of those that belong together: the signals as long
/// as most of the file's numbers are. The others are named in a remark.
class CollectedSignals {
 public:
  struct Signal {
    std::string name, unit;
    std::vector<double> values;
    int digits = 15;
  };

  /// What a number or a text beside the signals states of those in its group, struct or variable.
  struct Statement {
    std::string name;
    double interval = 0.0;  ///< [s]; 0: it states a unit
    std::string unit = {};
  };

  /// @param most_numbers that the file may hold in all (read_apart.hpp).
  CollectedSignals(std::string file, std::size_t most_numbers)
      : file_(std::move(file)), most_numbers_(most_numbers) {}

  /// To be called before memory is taken for them. @throws InputError when the sum of all that were announced
  /// is above what the file may hold.
  void announce(const std::string& name, const std::vector<std::size_t>& extent);

  /// Numbers of any count. @param digits significant ones: 7 in single precision, 15 in double.
  void add_numbers(std::string name, std::string unit, std::vector<double> values, int digits);

  /// A signal, of two samples at least; others are no use.
  void add(std::string name, std::string unit, std::vector<double> values, int digits);

  /// A matrix (rows x columns, stored column by column): a signal for each column, or for each row where
  /// there are fewer of these. @param name_of of the k-th signal, from 1, column or row.
  void add_matrix(const std::function<std::string(std::size_t, bool is_row)>& name_of,
                  const std::string& unit, const std::vector<double>& values, std::size_t rows,
                  std::size_t columns, int digits);

  /// A variable of MATLAB or Octave, stored column by column: a vector by its name, of a matrix its columns
  /// "a(:,2)" or rows "a(2,:)".
  void add_variable(const std::string& name, std::vector<double> values, std::size_t rows,
                    std::size_t columns, int digits);

  /// A single number: an interval where it is called dt, Ts or sampling_interval_s, a rate where fs, Fs or
  /// sampling_rate_hz; else of no use. A name with a path counts by its last part.
  /// @returns whether it is one of them.
  bool set(const std::string& name, double value);

  /// A text: a unit where it is called units, y_unit or acc_unit, a rate where fs or the like; else of no
  /// use.
  void add_text(const std::string& name, const std::string& text);

  /// What set() made of a number. @param interval [s]
  void set_interval(std::string name, double interval) { add_statement({std::move(name), interval}); }

  void add_statement(Statement one) { statements_.push_back(std::move(one)); }

  /// Times are in the unit that their signal states, by its name or beside it, and in seconds where it states
  /// none, which a remark then states. Where no signal states quantity and unit, names are recognised as
  /// people write them. A stated interval or unit holds for the signals of the innermost group around it; a
  /// number called "rate" alone, which may be that of a shaft, gives way to any other.
  /// @throws InputError when there is no signal of at least two samples, or when times and a stated interval
  /// contradict each other or times are in another unit, unless the format states them itself.
  RecordTable table(const RecordFormat& format) const;

  /// Of the signals that become the table. @throws InputError when there is none of at least two samples.
  std::size_t common_length() const;

  const std::string& file() const { return file_; }
  const std::vector<Signal>& signals() const { return signals_; }
  const std::vector<Statement>& statements() const { return statements_; }

 private:
  const Statement* interval_for(const std::string& signal, bool asked) const;
  const Statement* interval_of(const RecordTable& table, bool asked) const;
  std::string unit_for(const Signal& signal) const;
  void find_time(RecordTable& table, const RecordFormat& format) const;

  std::string file_;
  std::size_t most_numbers_;
  double announced_ = 0.0;
  std::vector<Signal> signals_;
  std::vector<Statement> statements_;
};

/// Of signals of several lengths the length that most numbers have; 0 without any.
std::size_t length_of_most_numbers(const std::vector<std::size_t>& lengths);

/// What reading a file may take.
struct ReadingLimits {
  std::size_t numbers = 0;  ///< in all
  double seconds = 0.0;     ///< of processor time
  std::size_t bytes = 0;    ///< of memory, beside what this process has
};

/// By a file's size: as many numbers as compression can have put into it, but no more than 2^25 (256 MiB) or
/// one for each of its bytes, nor than fit here (memory_need.hpp); memory for three copies of them; one
/// second and four more for each megabyte.
ReadingLimits reading_limits(std::size_t file_bytes);

/// Collects signals in a child process, whose crashes, endless loops and hunger for memory end as a message.
/// Damaged files make HDF5 1.10 do all three.
///
/// @param library that reads, for messages: "HDF5".
/// @param read called in the child; prints to nowhere.
/// @throws InputError that of `read`, and where the child crashes, does not end, or needs more than its
/// limits.
CollectedSignals read_apart(const std::string& file, const std::string& library, const ReadingLimits& limits,
                            const std::function<void(CollectedSignals&)>& read);

/// The same of texts, each no longer than the memory of the limits.
std::vector<std::string> texts_apart(const std::string& file, const std::string& library,
                                     const ReadingLimits& limits,
                                     const std::function<std::vector<std::string>()>& read);

// Matrices of a structure in MATLAB files (files/mat.cpp).

/// A real matrix of a MATLAB file of level 5 or 7.3, full or sparse, read in a child process.
/// @param variable its name; empty: the file's only matrix
/// @throws InputError where there is no such matrix, several without a name, or the file is damaged.
Eigen::SparseMatrix<double> read_mat_matrix(const std::filesystem::path& file, const std::string& variable);

}  // namespace beamid::experiments
