#include "fem/elements/frame_walk.hpp"

#include <algorithm>
#include <deque>
#include <numeric>

namespace beamid::fem {

std::vector<FrameStep> walk(const Frame& frame) {
  const std::size_t count = frame.joints.size();
  std::vector<int> held(count, 0);
  for (const Frame::Support& support : frame.supports)
    held[support.joint] =
        std::max(held[support.joint], int{support.x} + int{support.y} + int{support.rotation});
  std::vector<int> starts(count);
  std::iota(starts.begin(), starts.end(), 0);
  std::stable_sort(starts.begin(), starts.end(), [&](int a, int b) { return held[a] > held[b]; });
  std::vector<std::vector<std::size_t>> members(count);  // of each joint
  for (std::size_t i = 0; i < frame.members.size(); ++i)
    for (const int joint : {frame.members[i].first, frame.members[i].second}) members[joint].push_back(i);

  std::vector<FrameStep> steps;
  std::vector<bool> reached(count, false), taken(frame.members.size(), false);
  for (const int start : starts) {
    if (reached[start]) continue;
    reached[start] = true;
    std::deque<int> waiting{start};
    while (!waiting.empty()) {
      const int from = waiting.front();
      waiting.pop_front();
      for (const std::size_t i : members[from]) {
        if (taken[i]) continue;
        taken[i] = true;
        const bool reversed = frame.members[i].second == from;
        const int to = reversed ? frame.members[i].first : frame.members[i].second;
        steps.push_back({i, from, to, reversed});
        if (!reached[to]) waiting.push_back(to);
        reached[to] = true;
      }
    }
  }
  return steps;
}

}  // namespace beamid::fem
