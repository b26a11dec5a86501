// Files in thousands of forms, each made of parts that instruments, programs and people use: the record is
// what was written, or the file is refused with a sentence; never another record. Oracle: the generator,
// which has the instants and values.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "experiments/record/read_record.hpp"
#include "experiments/record/units.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::written_by_people_test {
namespace {

constexpr int rows = 24;
constexpr double interval = 0.0025;

struct Written {
  std::string text;
  double unit = 1.0;  // of the file's first signal, in SI units
  Quantity quantity = Quantity::acceleration;
  int signals = 1;
  bool stated = true;  // the file states its times
};

class Writer {
 public:
  explicit Writer(unsigned seed) : random_(seed) {}

  Written write() {
    Written written;
    const char separator = one_of(",;\t |");
    const char decimal = separator != ',' && one_in(3) ? ',' : '.';
    const std::string end = pick<std::string>({"\n", "\r\n"});
    const std::string between = separator == ' '                ? pick<std::string>({" ", "   ", "\t "})
                                : separator == ',' && one_in(4) ? ", "
                                                                : std::string(1, separator);
    const bool quoted = separator != ' ' && one_in(4), trailing = separator != ' ' && one_in(6);
    written.signals = 1 + below(3);
    const Time time = pick<Time>(times());
    const bool index = one_in(5), counted = time.stamp == nullptr;
    written.stated = !counted && !time.unstated;

    std::vector<std::string> names, units;
    const bool unit_row = one_in(4);
    const auto name = [&](std::string plain, std::string unit) {
      if (unit_row || unit.empty()) {
        names.push_back(plain), units.push_back(unit.empty() ? "-" : unit);
        return;
      }
      const std::string open = pick<std::string>({" [", " (", "["}),
                        close = open.find('[') != open.npos ? "]" : ")";
      names.push_back(plain + open + unit + close), units.push_back("");
    };
    if (index) names.push_back(pick<std::string>({"", "Nr", "Sample", "index"})), units.push_back("-");
    if (!counted) name(pick<std::string>(time.names), unit_row && time.unit.empty() ? "" : time.unit);
    const Signal signal = pick<Signal>(signals());
    written.quantity = signal.quantity;
    const bool with_unit = unit_row || !one_in(4);
    written.unit = with_unit ? signal.factor : 1.0;
    for (int k = 0; k < written.signals; ++k)
      name(signal.name + (written.signals > 1 ? fmt::format(" {}", "xyz"[k]) : ""),
           with_unit ? signal.unit : "");
    const bool units_stated =
        unit_row && !std::ranges::all_of(units, [](const auto& unit) { return unit == "-"; });

    std::string text = one_in(6) ? "\xEF\xBB\xBF" : "";
    if (separator == ';' && one_in(6)) text += "sep=;" + end;
    if (one_in(4)) text += metadata(end);
    const auto line = [&](std::vector<std::string> cells, bool quotes) {
      std::string result;
      for (std::size_t k = 0; k < cells.size(); ++k)
        result += (k ? between : "") + (quotes ? "\"" + cells[k] + "\"" : cells[k]);
      return result + (trailing ? std::string(1, separator) : "") + end;
    };
    const auto for_blanks = [&](std::vector<std::string> cells) {
      if (separator == ' ')
        for (std::string& cell : cells) {
          std::ranges::replace(cell, ' ', '_');
          if (cell.empty()) cell = "n";
        }
      return cells;
    };
    text += line(for_blanks(names), quoted || separator == ',' || one_in(3));
    if (units_stated) text += line(for_blanks(units), quoted);
    if (one_in(5)) text += end;
    const bool quoted_numbers = quoted && one_in(3);
    for (int k = 0; k < rows; ++k) {
      std::vector<std::string> cells;
      if (index) cells.push_back(std::to_string(k + 1));
      if (!counted) cells.push_back(stamp(time, k, separator));
      for (int s = 0; s < written.signals; ++s) cells.push_back(fmt::format("{:.5f}", value(k, s)));
      if (decimal == ',')
        for (std::string& cell : cells)
          if (cell.find(':') == cell.npos) std::ranges::replace(cell, '.', ',');
      text += line(cells, quoted_numbers);
      if (one_in(200)) text += "# a remark" + end;
    }
    if (one_in(6)) text += end + end;
    written.text = text;
    return written;
  }

  static double value(int row, int signal) {  // neither even nor rising
    return 4.0 * std::cos(0.7 * row + signal) - 0.01 * ((row * 37) % 11);
  }

 private:
  struct Time {
    std::vector<std::string> names;
    std::string unit;
    std::string (*stamp)(int);
    bool unstated = false;  // in a unit that nothing shows
  };
  struct Signal {
    std::string name, unit;
    Quantity quantity;
    double factor;
  };

  static std::vector<Time> times() {
    const std::vector<std::string> plain{"Time", "t", "Zeit", "temps", "Tiempo", "elapsed"},
        stamps{"Timestamp", "Date", "Zeitstempel", "DateTime"};
    return {
        {plain, "s", [](int k) { return fmt::format("{:.4f}", interval * k); }},
        {plain, "s", [](int k) { return fmt::format("{:.6E}", interval * k - 0.03); }},
        {plain, "", [](int k) { return fmt::format("{:.4f}", 17.0 + interval * k); }},
        {plain, "ms", [](int k) { return fmt::format("{:.1f}", 1e3 * interval * k); }},
        {plain, "us", [](int k) { return fmt::format("{}", 70000 + 2500 * k); }},
        {plain, "min", [](int k) { return fmt::format("{:.9f}", interval * k / 60.0); }},
        {{"millis"}, "", [](int k) { return fmt::format("{:.1f}", 9000.0 + 1e3 * interval * k); }},
        {{"micros"}, "", [](int k) { return fmt::format("{}", 9000000 + 2500 * k); }},
        {{"epoch", "time", "unix time"},
         "",
         [](int k) { return fmt::format("{:.4f}", 1.7e9 + interval * k); }},
        {{"timestamp"}, "", [](int k) { return fmt::format("{}", 1700000000000000LL + 2500 * k); }},
        {stamps, "", [](int k) { return fmt::format("2026-11-26T10:00:{:07.4f}Z", interval * k); }},
        {stamps, "", [](int k) { return fmt::format("26.11.2026 10:00:{:07.4f}", interval * k); }},
        {stamps, "", [](int k) { return fmt::format("11/26/2026 01:00:{:07.4f} PM", interval * k); }},
        {stamps, "", [](int k) { return fmt::format("26-Nov-2026 23:59:{:07.4f}", 59.0 + interval * k); }},
        {{"Time"}, "", [](int k) { return fmt::format("10:00:{:07.4f}", interval * k); }},
        {plain, "", [](int k) { return fmt::format("{}", 1e3 * interval * k); }, true},
        {{}, "", nullptr}};
  }

  static std::vector<Signal> signals() {
    return {{"Acceleration", "m/s^2", Quantity::acceleration, 1.0},
            {"Acc", "g", Quantity::acceleration, standard_gravity},
            {"Beschleunigung", "m/s²", Quantity::acceleration, 1.0},
            {"Accel-Tip", "mg", Quantity::acceleration, 1e-3 * standard_gravity},
            {"velocity", "mm/s", Quantity::velocity, 1e-3},
            {"Geschwindigkeit", "m/s", Quantity::velocity, 1.0},
            {"Displacement", "mm", Quantity::displacement, 1e-3},
            {"Weg", "mm", Quantity::displacement, 1e-3},
            {"Spostamento", "um", Quantity::displacement, 1e-6},
            {"strain", "um/m", Quantity::strain, 1e-6},
            {"Channel", "V", Quantity::acceleration, 1.0},
            {"Kanal", "mV", Quantity::acceleration, 1.0}};
  }

  std::string metadata(const std::string& end) {
    return pick<std::string>({"Recorder: X100" + end + "Operator,me" + end + "Date: 2026-11-26" + end + end,
                              "# made by logger 2.1" + end + "# serial 1234" + end,
                              "Start;26.11.2026 10:00:00" + end + "Channels;2" + end + end, "// logger" + end,
                              "Test 4" + end, "% exported by a program" + end + "%" + end});
  }

  std::string stamp(const Time& time, int k, char separator) {
    std::string text = time.stamp(k);
    if (separator == ' ') {
      const std::size_t half = text.find('M');  // of AM and PM, in one cell
      if (half != text.npos && text[half - 2] == ' ') text.erase(half - 2, 1);
      std::ranges::replace(text, ' ', 'T');
    }
    return text;
  }

  int below(int limit) { return static_cast<int>(random_() % static_cast<unsigned>(limit)); }
  bool one_in(int many) { return below(many) == 0; }
  char one_of(const std::string& letters) {
    return letters[static_cast<std::size_t>(below(static_cast<int>(letters.size())))];
  }
  template <class T>
  T pick(const std::vector<T>& choices) {
    return choices[static_cast<std::size_t>(below(static_cast<int>(choices.size())))];
  }

  std::mt19937 random_;
};

/// What is wrong with a record of the text; empty: nothing.
std::string difference(const Record& record, const Written& written) {
  if (record.size() != rows) return fmt::format("{} samples", record.size());
  if (static_cast<int>(record.channels.size()) != written.signals)
    return fmt::format("{} channels", record.channels.size());
  if (std::abs(record.interval() / interval - 1.0) > 1e-3)
    return fmt::format("interval {}", record.interval());
  for (int s = 0; s < written.signals; ++s) {
    if (record.channels[static_cast<std::size_t>(s)].quantity != written.quantity)
      return std::string("quantity ") + to_string(record.channels[static_cast<std::size_t>(s)].quantity);
    for (int k = 0; k < rows; ++k)
      if (std::abs(record.samples(s, k) - written.unit * Writer::value(k, s)) > 1e-5 * written.unit)
        return fmt::format("sample {} of channel {}: {}", k, s, record.samples(s, k));
  }
  return "";
}

TEST(WrittenByPeople, IsReadAsItWasWrittenOrRefused) {
  constexpr int cases = 20000;
  int right = 0, stated = 0;
  std::string refused;
  for (unsigned seed = 0; seed < cases; ++seed) {
    const Written written = Writer(seed).write();
    const TemporaryFile file("record.txt", written.text);
    stated += written.stated;
    try {
      const std::string wrong = difference(read_record(file.path(), {}), written);
      ASSERT_EQ(wrong, "") << "seed " << seed << "\n" << written.text.substr(0, 600);
      right += written.stated;
    } catch (const InputError& error) {
      if (written.stated && refused.size() < 2000)
        refused += fmt::format("seed {}: {}\n{}\n", seed, error.what(), written.text.substr(0, 200));
    }
  }
  EXPECT_GE(right, 0.97 * stated) << right << " of " << stated << "\n" << refused;
}

}  // namespace
}  // namespace beamid::experiments::written_by_people_test
