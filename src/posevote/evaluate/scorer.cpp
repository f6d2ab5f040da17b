#include "posevote/evaluate/scorer.hpp"

#include <algorithm>
#include <numeric>

namespace posevote {
namespace {

cv::Rect2d clip(const cv::Rect2d& box, cv::Size picture) {
  const double left = std::max(box.x, 0.0);
  const double top = std::max(box.y, 0.0);
  const double right = std::min(box.x + box.width, static_cast<double>(picture.width));
  const double bottom = std::min(box.y + box.height, static_cast<double>(picture.height));
  return {left, top, std::max(0.0, right - left), std::max(0.0, bottom - top)};
}

class Judge {
 public:
  Judge(const DatasetTest& test, const Dataset& dataset, cv::Size picture, double min_iou)
      : test_(test),
        dataset_(dataset),
        picture_(picture),
        min_iou_(min_iou),
        found_(test.objects.size()),
        twin_reported_(test.objects.size()) {}

  Judgement judge(const Claim& claim) {
    overlaps_.clear();
    for (const TruthObject& truth : test_.objects)
      overlaps_.push_back(clipped_iou(claim.box, truth.box, picture_));
    const auto named = [&](std::size_t i) { return test_.objects[i].name == claim.object; };
    const auto asked = [&](std::size_t i) { return test_.objects[i].asked(); };
    const auto twin = [&](std::size_t i) {
      return dataset_.are_twins(test_.objects[i].name, claim.object);
    };

    int best = best_fit([&](std::size_t i) { return named(i) && asked(i) && !found_[i]; });
    if (best >= 0) {
      found_[static_cast<std::size_t>(best)] = true;
      return make(Verdict::right, best);
    }
    best = best_fit([&](std::size_t i) { return named(i) && !asked(i); });
    if (best >= 0) return make(Verdict::ignored, best);
    best = best_fit(
        [&](std::size_t i) { return twin(i) && asked(i) && !found_[i] && !twin_reported_[i]; });
    if (best >= 0) {
      twin_reported_[static_cast<std::size_t>(best)] = true;
      return make(Verdict::twin, best);
    }
    best = best_fit([&](std::size_t i) { return twin(i) && !asked(i); });
    if (best >= 0) return make(Verdict::ignored, best);
    return make(Verdict::false_positive, nearest());
  }

  [[nodiscard]] bool found(std::size_t truth) const { return found_[truth]; }

 private:
  template <class Allowed>
  int best_fit(Allowed allowed) const {
    int best = -1;
    for (std::size_t i = 0; i < overlaps_.size(); ++i)
      if (overlaps_[i] >= min_iou_ && allowed(i) &&
          (best < 0 || overlaps_[i] > overlaps_[static_cast<std::size_t>(best)]))
        best = static_cast<int>(i);
    return best;
  }
  [[nodiscard]] int nearest() const {
    const auto best = std::ranges::max_element(overlaps_);
    return best == overlaps_.end() || *best <= 0 ? -1 : static_cast<int>(best - overlaps_.begin());
  }
  [[nodiscard]] Judgement make(Verdict verdict, int truth) const {
    return {verdict, truth, truth < 0 ? 0 : overlaps_[static_cast<std::size_t>(truth)]};
  }

  const DatasetTest& test_;
  const Dataset& dataset_;
  cv::Size picture_;
  double min_iou_;
  std::vector<bool> found_, twin_reported_;
  std::vector<double> overlaps_;
};

}  // namespace

const char* to_string(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::right:
      return "right";
    case Verdict::false_positive:
      return "false";
    case Verdict::twin:
      return "twin";
    case Verdict::ignored:
      return "ignored";
  }
  return "unknown";
}

double clipped_iou(const cv::Rect2d& a, const cv::Rect2d& b, cv::Size picture) {
  const cv::Rect2d first = clip(a, picture);
  const cv::Rect2d second = clip(b, picture);
  const double width =
      std::min(first.x + first.width, second.x + second.width) - std::max(first.x, second.x);
  const double height =
      std::min(first.y + first.height, second.y + second.height) - std::max(first.y, second.y);
  if (!(width > 0) || !(height > 0)) return 0;
  const double common = width * height;
  return common / (first.area() + second.area() - common);
}

Score score_claims(const std::vector<Claim>& claims, const DatasetTest& test,
                   const Dataset& dataset, cv::Size picture, double min_iou) {
  std::vector<std::size_t> order(claims.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater{},
                           [&](std::size_t i) { return claims[i].confidence; });
  Judge judge(test, dataset, picture, min_iou);
  Score score;
  score.judgements.resize(claims.size());
  for (const std::size_t i : order) {
    score.judgements[i] = judge.judge(claims[i]);
    switch (score.judgements[i].verdict) {
      case Verdict::right:
        ++score.right;
        break;
      case Verdict::false_positive:
        ++score.false_positives;
        break;
      case Verdict::twin:
        ++score.twins;
        break;
      case Verdict::ignored:
        ++score.ignored;
        break;
    }
  }
  for (std::size_t i = 0; i < test.objects.size(); ++i) {
    if (!test.objects[i].asked()) continue;
    ++score.asked;
    if (!judge.found(i)) score.missed.push_back(static_cast<int>(i));
  }
  return score;
}

}  // namespace posevote
