#include "posevote/feature/surf/select.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "posevote/feature/picture.hpp"

namespace posevote::surf {
namespace {

bool is_stronger(const Candidate* a, const Candidate* b) {
  const float first = a->response(), second = b->response();
  return std::tie(second, a->y, a->x, a->octave, a->layer) <
         std::tie(first, b->y, b->x, b->octave, b->layer);
}

// The strongest of every cell first, then the second of every cell, and so on; four key points are
// wanted of a cell on average.
void spread(std::vector<const Candidate*>& candidates, const Selection& selection) {
  std::ranges::sort(candidates, is_stronger);
  const double area = static_cast<double>(selection.size.area());
  const int cell = std::max(1, static_cast<int>(std::sqrt(4 * area / selection.max_features)));
  std::map<std::pair<int, int>, int> taken;
  std::vector<std::pair<int, const Candidate*>> ranked;
  for (const Candidate* candidate : candidates)
    ranked.emplace_back(taken[{candidate->y / cell, candidate->x / cell}]++, candidate);
  std::ranges::stable_sort(ranked, {}, &std::pair<int, const Candidate*>::first);
  std::ranges::transform(ranked, candidates.begin(),
                         [](const auto& entry) { return entry.second; });
}

}  // namespace

std::vector<Keypoint> select(std::vector<const Candidate*> candidates, const Selection& selection,
                             const Integral& integral) {
  const std::size_t limit = selection.max_features > 0
                                ? static_cast<std::size_t>(selection.max_features)
                                : candidates.size();
  const bool spreading = selection.spread && selection.max_features > 0;
  if (spreading) spread(candidates, selection);
  std::vector<Keypoint> keypoints;
  keypoints.reserve(std::min(limit, candidates.size()));
  std::size_t sorted = 0;
  for (std::size_t next = 0; next < candidates.size() && keypoints.size() < limit; ++next) {
    if (next == sorted && !spreading) {  // some are refused, so a few more than are wanted
      sorted = std::min(candidates.size(), sorted + limit + limit / 4 + 16);
      const auto begin = candidates.begin() + next, end = candidates.begin() + sorted;
      if (end != candidates.end()) std::nth_element(begin, end, candidates.end(), is_stronger);
      std::sort(begin, end, is_stronger);
    }
    Keypoint keypoint;
    if (refine(*candidates[next], integral, keypoint) &&
        is_inside_mask(selection.mask, keypoint.x, keypoint.y))
      keypoints.push_back(keypoint);
  }
  std::ranges::sort(keypoints, comes_before);
  return keypoints;
}

}  // namespace posevote::surf
