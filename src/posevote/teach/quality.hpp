// Is this view good enough to be recognised by? A card per view, in numbers and plain words.
#pragma once

#include <cmath>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "posevote/core/options.hpp"
#include "posevote/feature/features.hpp"
#include "posevote/model/view.hpp"

namespace posevote {

struct QualityOptions {
  FeatureOptions feature;       ///< those that the view was taught with
  double max_ratio = 0.88;      ///< a feature is told apart if right / wrong distance is below
  int needed_matches = 8;       ///< what recognition needs to be sure
  double max_gap_deg = 30;      ///< matches fall off beyond this turn between views (paper, fig. 5)
  double redundant_from = 0.8;  ///< share of known features from which a view adds little
  void describe(OptionList& list);
};

/// Shares are in [0, 1]; NaN where a value cannot be known.
struct ViewQuality {
  std::size_t features = 0;
  /// Share of the silhouette's cells (about 64, of equal size) that hold a feature.
  double coverage = 0;
  /// Share of the features that another place of the same view resembles about as much as a second
  /// picture of the right place does: repeated texture. NaN without a picture.
  double self_similarity = std::nan("");
  double size_px = 0;  ///< longer side of the object's box in the picture
  /// The same side in the smallest reduced copy of the picture that still gives `needed_matches`
  /// right matches, to a step of 1.4: the best case, sharp and unhidden. NaN without a picture.
  double smallest_size_px = std::nan("");
  /// Share of the features that match one of the object's other views. 0 without others.
  double redundancy = 0;
  /// Where the next picture helps most, in [0, 360): the first step into the largest gap between
  /// the yaws of all views; NaN when no gap exceeds `max_gap_deg` or this view's yaw is unknown.
  double next_yaw_deg = std::nan("");
  std::vector<std::string> advice;  ///< whole sentences, most important first; empty: a good view
};

/// `others`: the object's other views (`view` itself is skipped if among them; views with
/// descriptors of another length too). Deterministic. Takes about two feature extractions. Throws
/// what `make_extractor` throws.
[[nodiscard]] ViewQuality assess_view(const View& view,
                                      const std::vector<std::shared_ptr<const View>>& others,
                                      const QualityOptions& options = {});

/// See ViewQuality::redundancy; other arguments as for `assess_view`. 0 for a view without
/// features.
[[nodiscard]] double measure_redundancy(const View& view,
                                        const std::vector<std::shared_ptr<const View>>& others,
                                        const QualityOptions& options = {});

/// See ViewQuality::next_yaw_deg; NaN entries are left out. 0 for no yaw at all.
[[nodiscard]] double next_yaw(const std::vector<double>& yaws_deg, double max_gap_deg);

}  // namespace posevote
