// The pipeline of the paper: features, neighbours, votes, homographies, verification.
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "posevote/core/options.hpp"
#include "posevote/feature/features.hpp"
#include "posevote/index/index.hpp"
#include "posevote/match/matcher.hpp"
#include "posevote/model/model_set.hpp"
#include "posevote/verify/paper_rule.hpp"
#include "posevote/verify/verifier.hpp"
#include "posevote/vote/hough.hpp"

namespace posevote {

/// A pair of corresponding points that supports a detection.
struct MatchedPoint {
  cv::Point2f view;   ///< px of the taught picture
  cv::Point2f scene;  ///< px of the scene
};

/// One physical instance of a taught object in the scene.
struct Detection {
  std::string object;
  std::string view;                  ///< id of the taught view that explains it best
  double confidence = 0;             ///< Eq. 11: matched features / scene features in the area
  double probability = 0;            ///< that this object is there, and in this place
  double log10_false_alarms = 0;     ///< log10 of the expected number of such accidents per image
  Presence presence;                 ///< the probability's two parts
  PresenceEvidence measured;         ///< what they were made of
  int inliers = 0;                   ///< f_m of Eq. 11
  int features_in_area = 0;          ///< f_t of Eq. 11
  cv::Matx33d scene_from_view;       ///< homography, view px -> scene px, (2,2) = 1
  std::vector<cv::Point2f> outline;  ///< the view's silhouette in the scene, px
  cv::Rect2d box;                    ///< bounding box of the outline, not clipped, px
  std::vector<std::string> alternatives;  ///< objects that the evidence cannot tell apart from it
  std::vector<MatchedPoint> matches;      ///< the inliers
};

/// A textured part of the picture that no detection explains.
struct UnknownRegion {
  cv::Rect2f box;    ///< px, inside the picture
  int features = 0;  ///< of the scene, in it
};

struct StageTimes {
  double detect = 0, match = 0, vote = 0, verify = 0, total = 0;  ///< milliseconds
};

/// Numbers of features that survive each stage: the "# Key Points" of the paper's Table I.
struct StageCounts {
  int features = 0, matched = 0, clustered = 0, verified = 0;
};

struct RecognitionResult {
  cv::Size image_size;
  std::vector<Detection> detections;   ///< best first, each physical instance once
  std::vector<UnknownRegion> unknown;  ///< most features first; only with RecognizeOptions::unknown
  bool incomplete = false;  ///< RecognizeOptions::deadline_ms came before all was looked at
  StageTimes time_ms;
  StageCounts counts;
};

/// Everything that governs recognition; each stage's options are nested, never retyped.
struct RecognizeOptions {
  std::string rule = "a-contrario";  ///< "a-contrario" or "paper": how hypotheses are accepted
  FeatureOptions feature;
  IndexOptions index;
  MatchOptions match;
  VoteOptions vote;
  VerifyOptions verify;
  PaperOptions paper;
  int max_hypotheses = 400;  ///< clusters looked at per scene, strongest first
  bool unknown = false;      ///< also report what no object explains
  /// For one picture, 0: one per core. More than one also replaces `feature.surf.threads` and
  /// `index.threads`. The answer is the same for any number.
  int threads = 1;
  /// Time for a picture, 0: as much as it takes. The strongest features are matched and the
  /// strongest hypotheses verified first; what is left then is left out, so that answers depend on
  /// the machine. Features are extracted in any case: that must fit.
  double deadline_ms = 0;
  double max_overlap = 0.4;  ///< intersection over union of two detections of one object
  void describe(OptionList& list);
};

/// Names of the presets: "default", "paper", ...
[[nodiscard]] std::vector<std::string> preset_names();

/// Options of a preset; throws Error{invalid_argument} for a name that is none.
[[nodiscard]] RecognizeOptions make_preset(const std::string& name);

struct Trace;

/// Finds taught objects in pictures. `recognize` is const and may be called from many threads while
/// `set_models` swaps the objects; a running call finishes with those it began with.
class Recognizer {
 public:
  /// Throws Error{invalid_argument} for options out of range and Error{feature_mismatch} when
  /// `models` holds features of another kind than options.feature.
  /// `prepared`: what `save_prepared` gave for these models or others of which some are the same;
  /// spares most of the time that making a recogniser of many objects takes.
  explicit Recognizer(std::shared_ptr<const ModelSet> models, const RecognizeOptions& options = {},
                      const std::string& prepared = {});
  ~Recognizer();

  /// `image` as in `Extractor::extract`. Nothing found is a result without detections.
  [[nodiscard]] RecognitionResult recognize(const cv::Mat& image) const;

  /// Recognition with features that were extracted from `image` already.
  [[nodiscard]] RecognitionResult recognize(const Features& scene, const cv::Mat& image) const;

  /// `recognize`, with all that lay between: see trace.hpp.
  [[nodiscard]] Trace trace(const cv::Mat& image) const;

  void set_models(std::shared_ptr<const ModelSet> models);
  [[nodiscard]] std::shared_ptr<const ModelSet> models() const;

  /// What was found out about the present models, to be kept for the next start.
  [[nodiscard]] std::string save_prepared() const;
  [[nodiscard]] IndexStatistics index_statistics() const;
  [[nodiscard]] const RecognizeOptions& options() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace posevote
