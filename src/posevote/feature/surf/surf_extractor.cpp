#include "posevote/feature/surf/surf_extractor.hpp"

#include <mutex>
#include <vector>

#include "posevote/feature/surf/surf.hpp"

namespace posevote {
namespace {

// Lends workspaces to the threads that call `extract`; as many exist as ever ran at once.
class SurfExtractor final : public Extractor {
 public:
  explicit SurfExtractor(const FeatureOptions& options) : options_(options) {}

  Features extract(const cv::Mat& image, const cv::Mat& mask) const override {
    auto workspace = take();
    Features features = workspace->extract(image, mask, options_);
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
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<surf::Workspace>> idle_;
};

}  // namespace

std::shared_ptr<const Extractor> make_surf_extractor(const FeatureOptions& options) {
  return std::make_shared<SurfExtractor>(options);
}

}  // namespace posevote
