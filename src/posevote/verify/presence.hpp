// How probable is it that the object is there, and where the pose says?
//
// The number of false alarms answers whether the agreement is chance. It does not know what else
// there is in the world: another thing with the same logo, table or barcode agrees by no chance,
// and a solid object that was turned far from its taught view is there, but not where the pose
// says. Two logistic models (Cox 1958) on what was measured of a hypothesis answer those.
#pragma once

#include <cmath>
#include <limits>

#include "posevote/verify/agreement.hpp"

namespace posevote {

/// What was measured of a hypothesis.
struct PresenceEvidence {
  double digits = 0;      ///< -log10 of the number of false alarms
  double confidence = 0;  ///< Eq. 11
  double coverage = 0;    ///< share of the view's features in the part that was seen
  double distortion = 0;  ///< log of the largest over the smallest stretch of the pose
  Agreement agreement;    ///< `visible` 0: unknown
  double found = 0;       ///< share of the view's features with a candidate that were found
  /// Overlap (intersection over union) with what other views of the object say of the place,
  /// 0 ... 1; negative: none says anything.
  double consensus = -1;
};

/// Two probabilities by the natural logarithms of their odds, which still tell the nearly certain
/// from the certain.
struct Presence {
  double object_log_odds = -kCertain;
  double place_log_odds = -kCertain;
  /// Probability that it is this object and no other thing.
  [[nodiscard]] double object() const { return 1 / (1 + std::exp(-object_log_odds)); }
  /// Given that, probability that it is where the pose says.
  [[nodiscard]] double place() const { return 1 / (1 + std::exp(-place_log_odds)); }
  [[nodiscard]] double probability() const { return object() * place(); }

  static constexpr double kCertain = std::numeric_limits<double>::infinity();
};

[[nodiscard]] Presence rate_presence(const PresenceEvidence& evidence);

/// The probability that leaves so many false detections in 1000 pictures.
[[nodiscard]] double least_probability(double false_alarms_per_1000_images);

}  // namespace posevote
