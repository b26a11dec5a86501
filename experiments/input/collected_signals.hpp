// Signals found under names in a binary file, made one table.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "experiments/input/record_table.hpp"

namespace beamid::experiments {

/// Takes whatever numbers a file holds and makes a table of those that belong together: the signals as long
/// as most of the file's numbers are. The others are named in a remark.
class CollectedSignals {
 public:
  explicit CollectedSignals(std::string file) : file_(std::move(file)) {}

  /// @param digits significant ones: 7 in single precision, 15 in double.
  void add(std::string name, std::string unit, std::vector<double> values, int digits);

  /// A matrix (rows x columns, stored column by column): a signal for each column, or for each row where
  /// there are fewer of these. @param name_of of the k-th signal, from 1, column or row.
  void add_matrix(const std::function<std::string(std::size_t, bool is_row)>& name_of,
                  const std::string& unit, const std::vector<double>& values, std::size_t rows,
                  std::size_t columns, int digits);

  /// A single number: an interval where it is called dt, Ts or sampling_interval_s, a rate where fs, Fs or
  /// sampling_rate_hz; else of no use. A name with a path counts by its last part.
  /// @returns whether it is one of them.
  bool set(const std::string& name, double value);

  /// @throws InputError when there is no signal of at least two samples.
  RecordTable table() const;

 private:
  struct Signal {
    std::string name, unit;
    std::vector<double> values;
    int digits;
  };
  std::string file_;
  std::vector<Signal> signals_;
  double interval_ = 0.0;
};

}  // namespace beamid::experiments
