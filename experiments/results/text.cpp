#include "experiments/results/text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "experiments/results/gnuplot.hpp"

namespace beamid::experiments {
namespace {

void wrap_line(const std::string& line, std::size_t width, std::vector<std::string>& lines) {
  if (width_of(line) <= width) {
    lines.push_back(line);
    return;
  }
  const std::size_t indent = std::min(line.find_first_not_of(' '), width / 2);
  const std::string margin(indent + (line.compare(indent, 2, "- ") == 0 ? 2 : 0), ' ');
  std::istringstream words(line);
  std::string current(indent, ' '), word;
  bool empty = true;
  while (words >> word) {
    if (!empty && width_of(current) + 1 + width_of(word) > width) {
      lines.push_back(current);
      current = margin;
      empty = true;
    }
    current += (empty ? "" : " ") + word;
    empty = false;
  }
  lines.push_back(current);
}

/// Words of verdicts. They stand in capitals; what stands in capitals before them, as in THE RECORDS
/// DISAGREE, belongs to them.
constexpr std::array verdicts{"DIVERGED", "CONTRADICTED", "DISAGREE",   "ALIASED", "WRONG",
                              "WARNING",  "SETTLED",      "DETERMINED", "UNIQUE",  "RELY",
                              "diverged", "contradicted", "not_unique"};

bool in_capitals(const std::string& line, std::size_t from, std::size_t to) {
  return from < to &&
         std::all_of(line.begin() + static_cast<long>(from), line.begin() + static_cast<long>(to),
                     [](unsigned char c) { return std::isupper(c); });
}

bool is_letter(const std::string& line, std::size_t at) {
  return at < line.size() && std::isalnum(static_cast<unsigned char>(line[at]));
}

}  // namespace

std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xC0) != 0x80; }));
}

std::string emphasised(const std::string& line, const Page& page) {
  if (!page.colour) return line;
  for (const std::string verdict : verdicts) {
    const std::size_t at = line.find(verdict), end = at + verdict.size();
    if (at == std::string::npos || is_letter(line, end) || (at > 0 && is_letter(line, at - 1))) continue;
    std::size_t start = at;
    while (start > 1 && line[start - 1] == ' ') {
      const std::size_t blank = line.rfind(' ', start - 2), word = blank == std::string::npos ? 0 : blank + 1;
      if (!in_capitals(line, word, start - 1)) break;
      start = word;
    }
    return line.substr(0, start) + "\033[1;31m" + line.substr(start, end - start) + "\033[0m" +
           line.substr(end);
  }
  return line;
}

std::vector<std::string> wrapped(std::string_view text, std::size_t width) {
  std::vector<std::string> lines;
  std::istringstream stream{std::string(text)};
  for (std::string line; std::getline(stream, line);) wrap_line(line, width, lines);
  return lines;
}

namespace {

constexpr double tick_height = 34;  // [px] from label to label above each other

int step_decimals(double step) {
  return std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
}

// Whether numbers with this step are written out; if not, as "1.5e+06".
bool written_out(const AxisRange& range, double step) {
  return std::max(std::abs(range.first), std::abs(range.second)) < 1e6 && step_decimals(step) <= 6;
}

double label_width(const AxisRange& range, double step) {
  if (!written_out(range, step)) return 8 * tick_letter;
  const int decimals = step_decimals(step);
  std::size_t widest = 0;
  for (const double value : {range.first, range.second}) {
    const double tick = std::round(value / step) * step;
    widest = std::max(widest, fmt::format("{:.{}f}", tick, decimals).size());
  }
  return tick_letter * static_cast<double>(widest);
}

// Whether the labels stand clear of each other.
bool has_room(char name, const std::vector<double>& ticks, const AxisRange& range, double length) {
  const double decades = std::log10(range.second / range.first);
  for (std::size_t i = 0; i + 1 < ticks.size(); ++i) {
    const double distance = length * std::log10(ticks[i + 1] / ticks[i]) / decades;
    const auto width = [](double tick) {
      return tick_letter * static_cast<double>(fmt::format("{:g}", tick).size());
    };
    if (distance < (name == 'x' ? 0.5 * (width(ticks[i]) + width(ticks[i + 1])) + 10 : 0.6 * tick_height))
      return false;
  }
  return true;
}

Ticks listed(char name, const std::vector<double>& ticks) {
  Ticks found;
  std::string list;
  for (const double tick : ticks) {
    const std::string text = fmt::format("{:.6g}", tick);
    list += (list.empty() ? "" : ", ") + text;
    found.widest = std::max(found.widest, tick_letter * static_cast<double>(text.size()));
  }
  found.commands = fmt::format("  set format {0} '%g'; set {0}tics ({1})\n", name, list);
  return found;
}

}  // namespace

double rounded_up_step(double size) {
  const double power = std::pow(10.0, std::floor(std::log10(size)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (size <= factor * power * (1 + 1e-9)) return factor * power;
  return 10 * power;
}

double step_for(const AxisRange& range, double length, bool upright) {
  const double span = range.second - range.first;
  double step = rounded_up_step(span / 2);
  for (int count = 10; count > 1; --count) {
    const double finer = rounded_up_step(span / count);
    const double needed = upright ? tick_height : label_width(range, finer) + 16;
    if (needed * (span / finer) > length) continue;
    step = finer;
    break;
  }
  const auto ticks = [&] { return std::floor(range.second / step) - std::ceil(range.first / step) + 1; };
  while (ticks() < 2) step = rounded_up_step(0.35 * step);  // one number alone is no scale
  return step;
}

Ticks linear_ticks(char name, const AxisRange& range, double step) {
  const std::string format = written_out(range, step) ? fmt::format("%.{}f", step_decimals(step)) : "%g";
  return {fmt::format("  unset logscale {0}; set format {0} '{1}'; set {0}tics {2:g}; set m{0}tics default\n",
                      name, format, step),
          label_width(range, step)};
}

Ticks logarithmic_ticks(char name, const AxisRange& range, double length) {
  const double decades = std::log10(range.second / range.first);
  if (decades > 2.5)
    return {fmt::format("  set format {0} '10^{{%T}}'; set {0}tics autofreq; set m{0}tics 10\n", name),
            4.5 * tick_letter};
  const std::vector<double> sets[] = {
      {1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 9}, {1, 1.5, 2, 3, 4, 5, 7}, {1, 2, 5}, {1, 3}, {1}};
  const int first = static_cast<int>(std::floor(std::log10(range.first)));
  for (const auto& factors : sets) {
    std::vector<double> ticks;
    for (int power = first; power <= first + 3; ++power)
      for (const double factor : factors)
        if (const double tick = factor * std::pow(10.0, power); tick >= range.first && tick <= range.second)
          ticks.push_back(tick);
    if (ticks.size() >= 2 && has_room(name, ticks, range, length)) return listed(name, ticks);
  }
  std::vector<double> ticks;  // so short that it is all but linear
  const double step = step_for(range, length, name == 'y');
  for (double tick = std::ceil(range.first / step) * step; tick <= range.second; tick += step)
    ticks.push_back(tick);
  return listed(name, ticks);
}

Ticks named_ticks(const std::string& name, const std::vector<std::string>& names) {
  constexpr double letter = 7.6;  // [px], of words
  Ticks found;
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    list += fmt::format("{}{} {}", i == 0 ? "" : ", ", gnuplot_text(names[i]), i + 1);
    found.widest = std::max(found.widest, letter * static_cast<double>(width_of(names[i])));
  }
  found.commands = fmt::format("  unset logscale {0}; set {0}tics ({1})\n", name, list);
  return found;
}

std::string key_label(const std::string& key) {
  static const std::pair<const char*, const char*> units[] = {{"_n_s_per_m", "N s/m"},
                                                              {"_n_per_m", "N/m"},
                                                              {"_m_per_s2", "m/s2"},
                                                              {"_m_per_s", "m/s"},
                                                              {"_kg_per_m3", "kg/m3"},
                                                              {"_n_m2", "N m2"},
                                                              {"_kg", "kg"},
                                                              {"_hz", "Hz"},
                                                              {"_pa", "Pa"},
                                                              {"_percent", "%"},
                                                              {"_m", "m"},
                                                              {"_s", "s"},
                                                              {"_n", "N"}};
  std::string text = key, unit = key.ends_with("ratio") ? "-" : "";
  for (const auto& [ending, name] : units)
    if (text.ends_with(ending)) {
      text.resize(text.size() - std::string(ending).size());
      unit = name;
      break;
    }
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '.' || c == '_'; }, ' ');
  return unit.empty() ? text : text + " [" + unit + "]";
}

std::string shell_word(const std::string& word) {
  constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string result = "'";
  for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

}  // namespace beamid::experiments
