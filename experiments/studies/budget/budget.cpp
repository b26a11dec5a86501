#include "experiments/studies/budget/budget.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>

#include "experiments/text/countdown.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {
namespace {

using Order = std::vector<std::size_t>;

std::vector<Order> chosen_orders(int count, std::uint64_t seed) {
  Order order(cause_count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<Order> orders;
  filters::RandomStream random(seed, ~std::uint64_t{0});  // apart from the streams of noise
  while (static_cast<int>(orders.size()) < count) {
    orders.push_back(order);
    orders.emplace_back(order.rbegin(), order.rend());
    for (std::size_t i = cause_count - 1; i > 0; --i)
      std::swap(order[i], order[static_cast<std::size_t>(random.uniform() * static_cast<double>(i + 1))]);
  }
  return orders;
}

// The sets that an order passes through, from none to all.
std::vector<Causes> chain(const Order& order) {
  std::vector<Causes> sets{Causes()};
  for (const std::size_t i : order) sets.push_back(Causes(sets.back()).set(i));
  return sets;
}

}  // namespace

Budget make_budget(const std::string& name, const PipelineSettings& settings, int orders,
                   const Progress& progress) {
  if (orders < 2) throw std::invalid_argument("orders: " + std::to_string(orders) + "; expected 2 or more");
  Budget budget{name, Pipeline(settings), {}, {}, std::vector<Contribution>(cause_count), {}, 0};
  const std::vector<Order> sequences = chosen_orders(orders, settings.seed);

  std::set<unsigned long> needed;
  for (const Order& order : sequences)
    for (const Causes& on : chain(order)) needed.insert(on.to_ulong());
  for (std::size_t i = 0; i < cause_count; ++i) {
    needed.insert(Causes().set(i).to_ulong());
    needed.insert(all_causes().reset(i).to_ulong());
  }
  const std::vector<unsigned long> sets(needed.begin(), needed.end());
  std::vector<ParameterErrors> found(sets.size());
  Countdown countdown(progress, sets.size(), "runs");
  countdown.begin(name);
  tbb::parallel_for(std::size_t{0}, sets.size(), [&](std::size_t i) {
    found[i] = budget.pipeline.errors(Causes(sets[i]));
    countdown.count();
  });
  std::map<unsigned long, ParameterErrors> errors;
  for (std::size_t i = 0; i < sets.size(); ++i) errors[sets[i]] = found[i];
  const auto error = [&](const Causes& on) { return errors.at(on.to_ulong()); };

  budget.runs = static_cast<int>(sets.size());
  budget.clean = error({});
  budget.total = budget.interaction = error(all_causes());
  budget.interaction = budget.interaction - budget.clean;
  for (std::size_t i = 0; i < cause_count; ++i) {
    Contribution& share = budget.contributions[i];
    share.alone = error(Causes().set(i)) - budget.clean;
    share.without = budget.total - error(all_causes().reset(i));
    budget.interaction = budget.interaction - share.alone;
  }
  for (const Order& order : sequences) {
    const std::vector<Causes> stages = chain(order);
    for (std::size_t step = 0; step < cause_count; ++step) {
      const ParameterErrors added = error(stages[step + 1]) - error(stages[step]);
      Contribution& share = budget.contributions[order[step]];
      if (&order == &sequences.front()) share.in_sequence = added;
      share.average = share.average + added / static_cast<double>(sequences.size());
    }
  }
  return budget;
}

std::size_t largest(const std::vector<Contribution>& contributions, ParameterErrors Contribution::*way,
                    double ParameterErrors::*parameter) {
  const auto size = [&](const Contribution& c) { return std::abs(c.*way.*parameter); };
  const auto found = std::max_element(contributions.begin(), contributions.end(),
                                      [&](const auto& a, const auto& b) { return size(a) < size(b); });
  return static_cast<std::size_t>(found - contributions.begin());
}

}  // namespace beamid::experiments
