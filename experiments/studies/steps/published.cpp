#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/models/truth_behind.hpp"
#include "experiments/studies/steps/steps.hpp"

namespace beamid::experiments {
namespace {

FoundMode mode_of_oscillator(const Oscillator& one) {
  return {one.frequency_hz(), one.damping_ratio()};
}

// The truth behind a ratio that is seen at this frequency, or in a structure of it.
Oscillator truth_of_ratio(const PublishedDamping& published, double ratio) {
  const double omega = 2.0 * std::numbers::pi * published.frequency_hz, dt = published.interval;
  if (!published.is_true_frequency)
    return truth_behind(published.scheme, Oscillator::from_frequency(1.0, omega, ratio), dt);
  return truth_with_ratio(ratio, omega,
                          [&](const Oscillator& truth) { return seen_through(published.scheme, truth, dt); });
}

std::optional<double> ratio_with_process_noise(const PublishedDamping& published, double omega) {
  if (published.scheme != "forward_euler") return {};
  try {
    const auto seen = [&](const Oscillator& truth) {
      return regressed_by_forward_euler(truth, published.interval);
    };
    return truth_with_ratio(published.ratio, omega, seen).damping_ratio();
  } catch (const std::runtime_error&) {
    return {};
  }
}

}  // namespace

double half_digit_of(const std::string& number) {
  const std::size_t power = number.find_first_of("eE"), point = number.find('.');
  const std::string mantissa = number.substr(0, power);
  const double decimals = point < mantissa.size() ? static_cast<double>(mantissa.size() - point - 1) : 0.0;
  const double exponent = power == std::string::npos ? 0.0 : std::strtod(number.c_str() + power + 1, nullptr);
  return 0.5 * std::pow(10.0, exponent - decimals);
}

BehindPublished behind_published(const PublishedDamping& published) {
  BehindPublished found{published, {}, 0.0, 0.0, 0.0, {}};
  try {
    const Oscillator truth = truth_of_ratio(published, published.ratio);
    found.truth = mode_of_oscillator(truth);
    const double half = published.half_digit;
    found.lower = truth_of_ratio(published, std::max(published.ratio - half, -0.99)).damping_ratio();
    found.upper = truth_of_ratio(published, std::min(published.ratio + half, 0.99)).damping_ratio();
    found.least =
        seen_through(published.scheme, Oscillator::from_frequency(1.0, truth.angular_frequency(), 0.0),
                     published.interval)
            .damping_ratio();
    found.with_process_noise = ratio_with_process_noise(published, truth.angular_frequency());
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(error.what());
  }
  return found;
}

namespace {

using Json = nlohmann::ordered_json;
using Eigen::VectorXd;

std::string possible_text(const BehindPublished& found) {
  const PublishedDamping& p = found.published;
  const double times = p.ratio / found.truth.damping_ratio;
  std::string text = fmt::format(
      "A damping ratio of {:.5g} % that a {} filter found at steps of {:.5g} ms is that of a structure with "
      "{:.4g} % at {:.6g} Hz: ",
      100.0 * p.ratio, p.scheme, 1e3 * p.interval, 100.0 * found.truth.damping_ratio,
      found.truth.frequency_hz);
  text += std::abs(times - 1.0) < 0.005
              ? fmt::format("the discretisation changed it by {:+.2g} %", 100.0 * (times - 1.0))
              : fmt::format("the published value is {:.3g} times the true one", times);
  return text + fmt::format(
                    ". The published value's last digit allows {:.4g} to {:.4g} %. The added damping depends "
                    "little on the damping ratio, so the rounding error of the published value passes on "
                    "unchanged.",
                    100.0 * found.lower, 100.0 * found.upper);
}

std::string impossible_text(const BehindPublished& found) {
  const PublishedDamping& p = found.published;
  return fmt::format(
      "NOT POSSIBLE: no damped structure gives a {} filter a damping ratio of {:.5g} % at steps of {:.5g} ms "
      "and {:.6g} Hz. Of a motion without any damping it would find {:.5g} %. Scheme, step, frequency or the "
      "published value is another, or the filter had process noise on the motion.",
      p.scheme, 100.0 * p.ratio, 1e3 * p.interval, p.frequency_hz, 100.0 * found.least);
}

Table published_table(const BehindPublished& found) {
  const PublishedDamping& p = found.published;
  Table table{"published", ""};
  table.column({"", "quantity"})
      .column({"published", "published", "{:.6g}"})
      .column({"behind it", "truth", "{:.6g}"})
      .column({"last digit from", "lower", "{:.6g}"})
      .column({"to", "upper", "{:.6g}"});
  const double none = std::nan("");
  table.row({"damping ratio [%]", 100.0 * p.ratio, 100.0 * found.truth.damping_ratio, 100.0 * found.lower,
             100.0 * found.upper});
  table.row(
      {"frequency [Hz]", p.is_true_frequency ? none : p.frequency_hz, found.truth.frequency_hz, none, none});
  return table;
}

Figure published_figure(const BehindPublished& found) {
  const PublishedDamping& p = found.published;
  constexpr Eigen::Index points = 81;
  const double most = std::min(0.95, std::max(2.0 * found.truth.damping_ratio, 0.5 * p.ratio));
  VectorXd truth(points), seen(points);
  for (Eigen::Index i = 0; i < points; ++i) {
    const double ratio = most * static_cast<double>(i) / static_cast<double>(points - 1);
    truth[i] = 100.0 * ratio;
    try {
      seen[i] = 100.0 * seen_through(p.scheme,
                                     Oscillator::from_frequency(
                                         1.0, 2.0 * std::numbers::pi * found.truth.frequency_hz, ratio),
                                     p.interval)
                            .damping_ratio();
    } catch (const std::runtime_error&) {
      seen[i] = std::nan("");
    }
  }
  Panel panel{"", {"true damping ratio [%]"}, {"found [%]"}};
  panel.line(p.scheme, truth, seen, Colour::vermillion)
      .dashed("no error", truth, truth, Colour::black)
      .points("published", VectorXd::Constant(1, 100.0 * found.truth.damping_ratio),
              VectorXd::Constant(1, 100.0 * p.ratio), Colour::blue);
  Figure figure{"published_ratio", {panel}};
  figure.caption = fmt::format("What a {} filter finds at steps of {:.5g} ms and {:.5g} Hz, in closed form.",
                               p.scheme, 1e3 * p.interval, found.truth.frequency_hz);
  return figure;
}

}  // namespace

Results report(const BehindPublished& found) {
  const PublishedDamping& p = found.published;
  Results results;
  results.command = "steps";
  results.configuration = {
      {"published_xi", p.ratio},
      {"scheme", p.scheme},
      {"interval_s", p.interval},
      {"frequency_hz", p.frequency_hz},
      {"frequency_is", p.is_true_frequency ? "of the structure" : "found by the filter"}};
  if (!p.source.empty()) results.configuration["record"] = p.source;
  Json& values = results.values;
  values["status"] = found.is_possible() ? "possible" : "impossible";
  values["damping_ratio"] = {{"published", p.ratio},
                             {"behind_it", found.truth.damping_ratio},
                             {"lower", found.lower},
                             {"upper", found.upper}};
  values["frequency_hz"] = found.truth.frequency_hz;
  values["damping_ratio_found_of_no_damping"] = found.least;
  results.heading("The damping ratio behind a published one");
  if (!found.is_possible()) {
    results.warning(impossible_text(found), true);
  } else {
    results.paragraph(possible_text(found));
    if (found.lower <= 0.0)
      results.warning(
          "The published value's last digit does not distinguish the true damping ratio from zero.");
  }
  results.table(published_table(found));
  if (p.of_record) {
    values["record"] = {{"frequency_hz", p.of_record->frequency_hz},
                        {"damping_ratio", p.of_record->damping_ratio},
                        {"damping_ratio_standard_deviation", p.of_record->damping_ratio_deviation}};
    results.paragraph(fmt::format(
        "In {} the exact discretisation finds {:.4g} +- {:.2g} % at {:.6g} Hz: step and frequency are this "
        "record's.",
        p.source, 100.0 * p.of_record->damping_ratio,
        100.0 * quantile_95 * p.of_record->damping_ratio_deviation, p.of_record->frequency_hz));
  }
  std::string limits =
      "This holds for one observed channel, or several without process noise on the motion, and settled "
      "estimates.";
  if (found.with_process_noise) {
    values["damping_ratio"]["behind_it_with_process_noise"] = *found.with_process_noise;
    limits += fmt::format(
        " With displacement and velocity observed and process noise on the motion far above theirs, forward "
        "Euler adds half as much (K dt / 2 to C). Then {:.4g} % would lie behind the value.",
        100.0 * *found.with_process_noise);
  }
  results.paragraph(limits);
  if (found.is_possible()) results.figures.push_back(published_figure(found));
  return results;
}

}  // namespace beamid::experiments
