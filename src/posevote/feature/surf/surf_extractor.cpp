#include "posevote/feature/surf/surf_extractor.hpp"

#include <mutex>
#include <vector>

#include "posevote/feature/surf/surf.hpp"

namespace posevote {
namespace {

// Small pictures are searched from one octave lower, where small objects have too few pixels for
// the first octave; large ones have a limit in proportion to their area.
FeatureOptions suited_to(std::size_t pixels, FeatureOptions options) {
  constexpr double kLarge = 2e6;  // px
  if (pixels < static_cast<std::size_t>(options.double_below_px))
    options.surf.double_size = true;
  else if (options.more_in_large && static_cast<double>(pixels) > kLarge)
    options.max_features =
        static_cast<int>(options.max_features * static_cast<double>(pixels) / kLarge);
  return options;
}

// Lends workspaces to the threads that call `extract`; as many exist as ever ran at once.
class SurfExtractor final : public Extractor {
 public:
  SurfExtractor(const FeatureOptions& options, bool suits_size)
      : options_(options), suits_size_(suits_size) {}

  Features extract(const cv::Mat& image, const cv::Mat& mask) const override {
    auto workspace = take();
    Features features = workspace->extract(
        image, mask, suits_size_ ? suited_to(image.total(), options_) : options_);
    give_back(std::move(workspace));
    return features;
  }

 private:
  std::unique_ptr<surf::Workspace> take() const {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<surf::Workspace>();
    auto workspace = std::move(idle_.back());
    idle_.pop_back();
    return workspace;
  }

  void give_back(std::unique_ptr<surf::Workspace> workspace) const {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(workspace));
  }

  FeatureOptions options_;
  bool suits_size_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<surf::Workspace>> idle_;
};

}  // namespace

std::shared_ptr<const Extractor> make_surf_extractor(const FeatureOptions& options,
                                                     bool suits_size) {
  return std::make_shared<SurfExtractor>(options, suits_size);
}

}  // namespace posevote
