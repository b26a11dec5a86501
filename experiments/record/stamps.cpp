#include "experiments/record/stamps.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>

#include "experiments/signal/toolbox.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {
namespace {

constexpr double an_hour = 3600.0, a_day = 24.0 * an_hour;

/// Takes whole numbers and signs from the beginning of a text.
struct StampText {
  std::string_view rest;

  bool at_digit() const { return !rest.empty() && std::isdigit(static_cast<unsigned char>(rest.front())); }

  /// @returns -1 where no number of at most `digits` digits begins
  int number(std::size_t digits, std::size_t* taken = nullptr) {
    std::size_t length = 0;
    while (length < std::min(digits, rest.size()) && std::isdigit(static_cast<unsigned char>(rest[length])))
      ++length;
    int value = -1;
    if (length > 0) std::from_chars(rest.data(), rest.data() + length, value);
    rest.remove_prefix(length);
    if (taken) *taken = length;
    return value;
  }
  bool take(char sign) {
    if (rest.empty() || rest.front() != sign) return false;
    rest.remove_prefix(1);
    return true;
  }
  /// Its first sign, where it is one of these; else '\0'.
  char take_any(std::string_view signs) {
    if (rest.empty() || signs.find(rest.front()) == signs.npos) return '\0';
    const char sign = rest.front();
    rest.remove_prefix(1);
    return sign;
  }
};

/// 1 to 12 of "Jan" to "Dec", in English, German, French, Spanish or Italian; else 0.
int month_of(std::string_view letters) {
  if (letters.size() < 3) return 0;
  std::string word(letters.substr(0, 3));
  for (char& letter : word) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  static constexpr std::array<std::string_view, 12> names{
      "jan ene gen", "feb fev", "mar mrz", "apr abr avr", "may mai mag", "jun jui giu",
      "jul lug",     "aug ago", "sep set", "oct okt ott", "nov",         "dec dez dic"};
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k].find(word) != names[k].npos) return static_cast<int>(k) + 1;
  return 0;
}

/// Days since 1970-01-01.
std::optional<double> take_date(StampText& text) {
  StampText ahead = text;
  std::size_t digits = 0;
  int first = ahead.number(4, &digits);
  const char sign = first < 0 ? '\0' : ahead.take_any("-/.");
  if (sign == '\0') return {};
  int year = first, month = 0, day = 0;
  if (digits == 4) {
    month = ahead.number(2);
    if (!ahead.take(sign)) return {};
    day = ahead.number(2);
  } else {
    std::size_t letters = 0;
    while (letters < ahead.rest.size() && std::isalpha(static_cast<unsigned char>(ahead.rest[letters])))
      ++letters;
    int second = 0;
    if (letters > 0) {
      second = month_of(ahead.rest.substr(0, letters));
      ahead.rest.remove_prefix(letters);
    } else {
      second = ahead.number(2);
    }
    if (!ahead.take(sign)) return {};
    year = ahead.number(4, &digits);
    if (digits == 2) year += 2000;
    const bool month_first = letters == 0 && sign == '/' && first <= 12;
    month = month_first ? first : second;
    day = month_first ? second : first;
    if (digits != 2 && digits != 4) return {};
  }
  if (ahead.at_digit() || month < 1 || day < 1) return {};
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return {};
  text = ahead;
  return static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

/// Seconds since midnight. @param decimals of them, set; @param parts of the second behind a colon, set
std::optional<double> take_time_of_day(StampText& text, bool dated, int& decimals, int& parts) {
  StampText ahead = text;
  const auto fraction = [&] {
    double value = 0.0, place = 0.1;
    for (decimals = 0; ahead.at_digit(); ++decimals, place *= 0.1) value += place * ahead.number(1);
    return value;
  };
  std::size_t digits = 0;
  const int first = ahead.number(2);
  const char sign = first < 0 ? '\0' : ahead.take_any(dated ? ":." : ":");
  if (sign == '\0') return {};
  const int second = ahead.number(2, &digits);
  if (second < 0 || digits != 2) return {};
  double seconds = 0.0;
  if (ahead.take(sign)) {
    const int third = ahead.number(2, &digits);
    if (third < 0 || digits != 2 || first > 24 || second > 59 || third > 60) return {};
    seconds = an_hour * first + 60.0 * second + third;
    const char point = ahead.take_any(".,:");
    if (point == ':') {
      if (ahead.at_digit()) parts = ahead.number(6, &digits), decimals = static_cast<int>(digits);
      seconds += parts < 0 ? 0.0 : parts * std::pow(10.0, -decimals);
    } else if (point != '\0') {
      seconds += fraction();
    }
  } else if (!dated && ahead.take_any(".,") != '\0' && second < 60) {
    seconds = 60.0 * first + second + fraction();
  } else {
    return {};
  }
  StampText half = ahead;
  half.take(' ');
  if (half.rest.size() >= 2 && (half.rest[1] == 'M' || half.rest[1] == 'm')) {
    const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(half.rest[0])));
    if (letter == 'A' || letter == 'P') {
      if (first < 1 || first > 12) return {};
      seconds += an_hour * ((letter == 'P' ? 12 : 0) - (first == 12 ? 12 : 0));
      half.rest.remove_prefix(2);
      ahead = half;
    }
  }
  text = ahead;
  return seconds;
}

/// Of "+01:00" or "-0530" [s]; 0 without one.
double take_offset(StampText& text) {
  if (text.take('Z')) return 0.0;
  if (text.rest.starts_with(" +") || text.rest.starts_with(" -")) text.take(' ');
  const char sign = text.take_any("+-");
  if (sign == '\0') return 0.0;
  const int hours = text.number(2);
  text.take(':');
  return (sign == '-' ? -1.0 : 1.0) * (an_hour * std::max(0, hours) + 60.0 * std::max(0, text.number(2)));
}

/// "20261126T100000.000Z" with its signs.
std::string with_signs(std::string_view text) {
  const auto digits = [&](std::size_t from, std::size_t count) {
    return text.size() >= from + count &&
           text.substr(from, count).find_first_not_of("0123456789") == text.npos;
  };
  if (text.size() < 15 || text[8] != 'T' || !digits(0, 8) || !digits(9, 6)) return std::string(text);
  const auto part = [&](std::size_t from, std::size_t count) {
    return std::string(text.substr(from, count));
  };
  return part(0, 4) + '-' + part(4, 2) + '-' + part(6, 2) + 'T' + part(9, 2) + ':' + part(11, 2) + ':' +
         std::string(text.substr(13));
}

/// "0.0025 sec", "2.5 ms": a duration as MATLAB prints one. Its decimals are those of the seconds.
std::optional<Stamp> elapsed(std::string_view text) {
  const std::size_t blank = text.rfind(' ');
  if (blank == text.npos) return {};
  const std::string_view unit = text.substr(blank + 1), number = trimmed(text.substr(0, blank));
  const bool seconds = unit == "sec" || unit == "s";
  if (!seconds && unit != "ms") return {};
  const ParsedNumber parsed = parse_number(number);
  const std::size_t point = number.find('.');
  if (!parsed.finite || number.find_first_not_of("0123456789.") != number.npos) return {};
  const int decimals = point == number.npos ? 0 : static_cast<int>(number.size() - point) - 1;
  return Stamp{Stamp::Kind::time_of_day, parsed.value * (seconds ? 1.0 : 1e-3), decimals + (seconds ? 0 : 3)};
}

}  // namespace

std::optional<Stamp> parse_stamp(std::string_view field) {
  StampText text{trimmed(field)};
  if (const auto duration = elapsed(text.rest)) return duration;
  if (text.rest.starts_with("0 days ")) text.rest.remove_prefix(7);  // of pandas
  std::string spelled;
  if (text.rest.size() > 8 && text.rest[8] == 'T') text.rest = spelled = with_signs(text.rest);
  if (text.rest.size() < 6 || !text.at_digit()) return {};  // "1:23.4"
  Stamp stamp;
  const auto days = take_date(text);
  if (days) {
    stamp.seconds = *days * a_day;
    if (text.rest.empty()) return stamp;
    if (text.take_any("T ,_-") == '\0') return {};
    text.take(' ');
  }
  const auto of_day = take_time_of_day(text, days.has_value(), stamp.decimals, stamp.parts);
  if (!of_day) return {};
  stamp.kind = days ? Stamp::Kind::date_and_time : Stamp::Kind::time_of_day;
  stamp.seconds += *of_day;
  if (days) stamp.seconds -= take_offset(text);
  const bool zone = text.rest.size() >= 4 && text.rest.size() <= 5 && text.rest.front() == ' ' &&
                    std::ranges::all_of(text.rest.substr(1), [](char c) { return c >= 'A' && c <= 'Z'; });
  if (days && zone) text.rest = {};  // "UTC", "CET", "CEST": one offset throughout
  return text.rest.empty() ? std::optional(stamp) : std::nullopt;
}

std::optional<double> parts_of_second(const std::vector<double>& seconds, const std::vector<int>& parts,
                                      bool padded) {
  if (padded) return {};
  const int most = *std::ranges::max_element(parts);
  if (most >= 100) return 1000.0;  // ":5", ":50", ":500"
  std::vector<double> steps, jumps;
  for (std::size_t k = 1; k < parts.size(); ++k)
    (seconds[k] == seconds[k - 1] ? steps : jumps).push_back(parts[k] - parts[k - 1]);
  if (steps.empty() || jumps.empty()) return {};
  const double step = median(std::move(steps)), last = step - median(std::move(jumps));
  constexpr double hundredths = 100.0, off = 5.0;
  if (std::abs(last - hundredths) <= off && most > 60) return hundredths;
  return step >= 1.0 && last == most + step && last >= 10.0 ? std::optional(last) : std::nullopt;  // frames
}

std::string printed_like(const Stamp& stamp) {
  std::string printed = stamp.kind == Stamp::Kind::time_of_day ? "10000" : "1000000000";
  if (stamp.decimals > 0) printed += '.' + std::string(static_cast<std::size_t>(stamp.decimals), '1');
  return printed;
}

bool swings(const std::vector<double>& values) {
  std::size_t falls = 0, below = 0;
  for (std::size_t k = 1; k < values.size(); ++k)
    falls += values[k] < values[k - 1] ? 1 : 0, below += values[k] < 0.0 ? 1 : 0;
  return 5 * falls > values.size() && 5 * below > values.size();
}

bool counts_rows(const std::vector<double>& values) {
  for (std::size_t k = 1; k < values.size(); ++k)
    if (values[k] != values[k - 1] + 1.0) return false;
  return values.size() > 1;
}

bool counts_samples(const std::vector<double>& values) {
  return !values.empty() && (values[0] == 0.0 || values[0] == 1.0) && counts_rows(values);
}

bool rises(const std::vector<double>& values) {
  for (std::size_t k = 1; k < values.size(); ++k)
    if (!(values[k] > values[k - 1])) return false;
  return values.size() > 1;
}

double seconds_of_epoch(const std::vector<double>& stamps) {
  // A step that would be 200 kHz in seconds is 2.3 Hz in days.
  constexpr double a_day = 86400.0, fastest = 5e-6, longest = 30.0;
  if (stamps.empty()) return 1.0;
  const double first = stamps.front(), step = stamps.size() > 1 ? stamps[1] - first : 1.0;
  const bool date = (first > 3e4 && first < 7e4) || (first > 6.9e5 && first < 8e5) ||
                    (first > 2.4e6 && first < 2.5e6);  // of a workbook, of MATLAB, of Julius
  if (date && step > 0.0 && step < fastest && stamps.back() - first < longest) return a_day;
  if ((first > 6.2e17 && first < 6.8e17) || (first > 1.2e17 && first < 1.5e17))
    return 1e-7;                                    // since 1 and 1601
  constexpr double earliest = 9.4e8, latest = 4e9;  // 1999, 2096
  for (const double unit : {1e-9, 1e-6, 1e-3})
    if (first * unit > earliest && first * unit < latest) return unit;
  return 1.0;
}

namespace {

/// Whether steps are positive, and but for a few times the usual one where it began again.
bool begins_again(const std::vector<double>& values, double range) {
  const bool of_counter = range > 60.0;
  const std::size_t most_drops = range > 65536.0 ? 100 : values.size() / 4;
  std::size_t drops = 0;
  double rise = 0.0, longest = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!(values[k] >= 0.0 && values[k] < range) || (of_counter && values[k] != std::floor(values[k])))
      return false;
    if (k == 0) continue;
    if (const double step = values[k] - values[k - 1]; step > 0.0)
      rise += step, longest = std::max(longest, step);
    else if (++drops > most_drops)
      return false;
  }
  if (drops == 0 || !(rise > 0.0)) return false;
  const double usual = rise / static_cast<double>(values.size() - 1 - drops),
               like_others = range > 65536.0 ? 20.0 : 2.5;
  if (range <= 65536.0 && longest > like_others * usual) return false;  // no motion rises so
  for (std::size_t k = 1; k < values.size(); ++k)
    if (const double step = values[k] - values[k - 1];
        step <= 0.0 && !(step + range > 0.0 && step + range < like_others * usual))
      return false;
  return true;
}

}  // namespace

std::optional<double> go_on_past_range(std::vector<double>& values) {
  if (values.size() < 3) return {};
  for (const double range : {4294967296.0, 65536.0, 60.0}) {
    if (!begins_again(values, range)) continue;
    double offset = 0.0, before = values[0];
    for (double& value : values) {
      offset += value < before ? range : 0.0;
      before = value;
      value += offset;
    }
    return range;
  }
  return {};
}

double mean_step(const std::vector<double>& stamps) {
  return stamps.size() < 2 ? 0.0 : (stamps.back() - stamps.front()) / static_cast<double>(stamps.size() - 1);
}

std::pair<double, double> range_of_steps(const std::vector<double>& stamps) {
  std::pair range(stamps[1] - stamps[0], stamps[1] - stamps[0]);
  for (std::size_t k = 2; k < stamps.size(); ++k) {
    range.first = std::min(range.first, stamps[k] - stamps[k - 1]);
    range.second = std::max(range.second, stamps[k] - stamps[k - 1]);
  }
  return range;
}

double usual_step(const std::vector<double>& stamps) {
  std::vector<double> steps(stamps.size() - 1);
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k] = stamps[k + 1] - stamps[k];
  return median(std::move(steps));
}

bool runs_evenly(const std::vector<double>& values) {
  constexpr double tolerated = 0.05;
  const double step = mean_step(values);
  if (!(step > 0.0)) return false;
  for (std::size_t k = 1; k < values.size(); ++k)
    if (!(std::abs(values[k] - values[k - 1] - step) <= tolerated * step)) return false;
  return true;
}

std::optional<EvenStamps> without_rounding(const std::vector<double>& times, double resolution) {
  // Rounding is half a resolution at most; 0.57 is the most that a line through 200 records left.
  constexpr double most_off = 0.65, none_off = 1e-6, least = 2e-3;
  const std::size_t size = times.size();
  if (size < 3 || resolution <= least * range_of_steps(times).first) return std::nullopt;
  const double usual = usual_step(times);
  if (!(resolution > least * usual && resolution < 0.5 * usual)) return std::nullopt;
  std::vector<double> count{0.0};
  for (std::size_t k = 1; k < size; ++k)
    count.push_back(count.back() + std::max(std::round((times[k] - times[k - 1]) / usual), 1.0));

  double mean_count = 0.0, mean_time = 0.0, squares = 0.0, products = 0.0;
  for (std::size_t k = 0; k < size; ++k) {
    mean_count += count[k] / static_cast<double>(size);
    mean_time += (times[k] - times[0]) / static_cast<double>(size);
  }
  for (std::size_t k = 0; k < size; ++k) {
    squares += (count[k] - mean_count) * (count[k] - mean_count);
    products += (count[k] - mean_count) * (times[k] - times[0] - mean_time);
  }
  EvenStamps line{{}, products / squares};
  double off = 0.0;
  for (std::size_t k = 0; k < size; ++k) {
    line.times.push_back(times[0] + mean_time + (count[k] - mean_count) * line.interval);
    off = std::max(off, std::abs(times[k] - line.times[k]));
  }
  if (off > most_off * resolution || off < none_off * resolution) return std::nullopt;
  return line;
}

std::optional<SharedStamps> shared_stamps(const std::vector<double>& times,
                                          const std::vector<std::vector<double>>& columns) {
  constexpr std::size_t fewest_stamps = 4;
  constexpr double alike = 1e-6;  // of a step
  std::vector<std::size_t> begins;
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (k > 0 && !(times[k] >= times[k - 1])) return {};
    if (k == 0 || times[k] > times[k - 1]) begins.push_back(k);
  }
  const std::size_t stamps = begins.size();
  if (stamps < fewest_stamps) return {};
  SharedStamps shared{times[begins[1]] - times[0], times.size(), 0, stamps - 2, 0.0, 0.0, true};
  std::size_t alone = 0;
  for (std::size_t i = 1; i + 1 < stamps; ++i) {
    const std::size_t count = begins[i + 1] - begins[i];
    shared.fewest = std::min(shared.fewest, count), shared.most = std::max(shared.most, count);
    alone += count == 1 ? 1 : 0;
    const double step = times[begins[i + 1]] - times[begins[i]];
    shared.steady = shared.steady && std::abs(step - shared.step) <= alike * shared.step;
  }
  if (2 * alone >= shared.whole) return {};
  const bool moves = std::ranges::any_of(columns, [&](const std::vector<double>& values) {
    for (std::size_t k = 1; k < std::min(values.size(), times.size()); ++k)
      if (times[k] == times[k - 1] && values[k] != values[k - 1] && !std::isnan(values[k])) return true;
    return false;
  });
  if (!moves) return {};
  const auto cut = begins[1], last = begins[stamps - 1];
  shared.mean = static_cast<double>(last - cut) / static_cast<double>(shared.whole);
  shared.most = std::max({shared.most, cut, times.size() - last});  // a part has no more than a whole
  if (!shared.steady) shared.step = (times[last] - times[cut]) / static_cast<double>(shared.whole);
  shared.first = times[cut] - shared.step * static_cast<double>(cut) / shared.mean;
  return shared;
}

}  // namespace beamid::experiments
