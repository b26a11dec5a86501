#include "apps/option.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>

namespace beamid::apps {
namespace {

Option changed(Option option, const auto& change) {
  change(option);
  return option;
}

}  // namespace

std::string upper_case(std::string text) {
  for (char& letter : text) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return text;
}

Option Option::by_default(const std::string& word) const {
  return changed(*this, [&](Option& option) { option.fallback = word; });
}

Option Option::as(char short_form) const {
  return changed(*this, [&](Option& option) { option.letter = short_form; });
}

Option Option::repeated() const {
  return changed(*this, [](Option& option) { option.repeats = true; });
}

Option Option::needed() const {
  return changed(*this, [](Option& option) { option.required = true; });
}

Option Option::several() const {
  return changed(*this, [](Option& option) { option.values = all; });
}

Option Option::unrecorded() const {
  return changed(*this, [](Option& option) { option.recorded = false; });
}

Option Option::from(double bound) const {
  return changed(*this, [&](Option& option) { option.least = bound; });
}

Option Option::up_to(double bound) const {
  return changed(*this, [&](Option& option) { option.most = bound; });
}

Option Option::greater_than(double bound) const {
  return changed(*this, [&](Option& option) { option.least = bound, option.above = true; });
}

Option Option::less_than(double bound) const {
  return changed(*this, [&](Option& option) { option.most = bound, option.below = true; });
}

Option Option::one_of(const Words& names) const {
  return changed(*this, [&](Option& option) { option.choices = names, option.closed = true; });
}

Option Option::such_as(const Words& names) const {
  return changed(*this, [&](Option& option) { option.choices = names; });
}

std::string Option::expected() const {
  std::string text;
  if (closed) {
    for (std::size_t i = 0; i < choices.size(); ++i)
      text += (i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ") + choices[i];
    return text;
  }
  if (type == Type::text) return value;
  text = type == Type::whole ? "a whole number" : "a number";
  if (std::isfinite(least)) text += fmt::format(" {} {:.12g}", above ? "above" : "from", least);
  if (!std::isfinite(most)) return text;
  const char* joint = !std::isfinite(least) ? (below ? " below" : " up to")
                      : below               ? " and below"
                      : above               ? " and at most"
                                            : " to";
  return text + fmt::format("{} {:.12g}", joint, most);
}

std::string Option::synopsis() const {
  const std::string form = letter ? fmt::format("-{}, --{}", letter, name) : "    --" + name;
  return form + (value.empty() ? "" : " " + value);
}

Option flag(const std::string& name, const std::string& help) {
  return changed({name, "", help},
                 [](Option& option) { option.type = Option::Type::flag, option.values = 0; });
}

Option text(const std::string& name, const std::string& value, const std::string& help) {
  return {name, value, help};
}

Option number(const std::string& name, const std::string& value, const std::string& help) {
  return {name, value, help, Option::Type::number};
}

Option whole(const std::string& name, const std::string& value, double least, double most,
             const std::string& help) {
  return Option{name, value, help, Option::Type::whole}.from(least).up_to(most);
}

Option from_to(const std::string& name, const std::string& help) {
  return changed({name, "FROM TO", help, Option::Type::number}, [](Option& option) { option.values = 2; });
}

Option config_option(const std::string& help) {
  return text("config", "FILE", help).as('c');
}

Option band_option(const std::string& help) {
  return from_to("band", help).from(0);
}

OptionGroup output_options() {
  return {
      "Output",
      {text("out", "DIR", "write results.json, tables, figures and report.html there").as('o').unrecorded(),
       flag("force", "replace the results that DIR holds").unrecorded(),
       flag("json", "print results.json instead of text").unrecorded(),
       flag("quiet", "print the first lines and the first table only, and no progress").as('q').unrecorded(),
       flag("verbose", "report on standard error what is done and when, a line each, to a file too")
           .as('v')
           .unrecorded(),
       flag("no-progress", "do not show on standard error what is being done").unrecorded()}};
}

const std::vector<Option>& common_options() {
  static const std::vector<Option> options{flag("help", "show this help").as('h'),
                                           flag("version", "print the version").as('V')};
  return options;
}

}  // namespace beamid::apps
