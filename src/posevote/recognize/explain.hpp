// Why was an object found, or where did its evidence die?
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "posevote/recognize/recognizer.hpp"

namespace posevote {

/// What became of one object in one picture, stage by stage.
struct Explanation {
  std::string object;
  bool found = false;

  int scene_features = 0;         ///< found in the picture
  int similar = 0;                ///< of those, with a feature of the object among their neighbours
  int matched = 0;                ///< of those, nearer to the object than to any other (the ratio)
  int largest_bin = 0;            ///< most scene features that voted for one pose of one view
  int clusters = 0;               ///< bins with enough votes
  std::optional<Detection> best;  ///< the strongest pose, accepted or not; none without a cluster

  /// Where it ended: "found", "features", "similar", "ratio", "votes", "pose", "chance", "object",
  /// "place" or "competition".
  std::string stage;
  std::string reason;  ///< one plain sentence
  std::string option;  ///< the option that governs that stage; "" for none

  std::vector<MatchedPoint> matches;      ///< all that passed the ratio
  std::vector<cv::Point2f> vote_centres;  ///< where each of them puts the object's centre, scene px
};

/// Looks for `object` in `image` and says what happened. Throws Error{not_found} for an object that
/// `recognizer` does not know; else as `Recognizer::recognize`.
[[nodiscard]] Explanation explain(const Recognizer& recognizer, const cv::Mat& image,
                                  const std::string& object);

/// The same from what `Recognizer::trace` gave, for several objects of one picture. `options`: the
/// recogniser's.
[[nodiscard]] Explanation explain(const Trace& trace, const RecognizeOptions& options,
                                  const std::string& object);

/// What the explanation counts, for people: (what, how much), in the order of the stages.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> stages_of(
    const Explanation& explanation);

}  // namespace posevote
