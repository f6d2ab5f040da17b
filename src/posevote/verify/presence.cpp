#include "posevote/verify/presence.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace posevote {
namespace {

constexpr int kInputs = 8;
using Inputs = std::array<double, kInputs>;

struct Model {
  double bias;
  Inputs weights;
};

// Fitted on the development sets: bench/calibrate_presence.py says how, and prints these lines.
constexpr Model kObject{-5.90, {1.687, 0.936, 3.998, 0.950, 3.892, -10.057, 4.756, 1.637}};
constexpr Model kPlace{-3.62, {1.213, -0.766, 3.728, 2.963, 2.259, 1.292, -2.488, -1.279}};

/// Fitted to what the same script says of sets left out. False detections per 1000 pictures at odds
/// o of the least probability: at_even_odds * o ^ (-1 / steepness).
struct Dial {
  double at_even_odds, steepness;
};
constexpr Dial kDial{33, 1.28};

/// What a view without a patch is credited with: the lower quartile of right detections.
constexpr Agreement kUnknown{0.5, 0.7, 0.1, 1};

Inputs inputs_of(const PresenceEvidence& evidence) {
  const Agreement& agreement = evidence.agreement.visible > 0 ? evidence.agreement : kUnknown;
  return {std::log10(1 + std::max(0.0, evidence.digits)),
          std::log(evidence.confidence + 0.01),
          std::sqrt(evidence.coverage),
          agreement.structure,
          agreement.structure_near_matches,
          agreement.colour_difference,
          agreement.visible,
          evidence.distortion * (1 - evidence.coverage)};
}

double evaluate(const Model& model, const Inputs& inputs) {
  double sum = model.bias;
  for (int i = 0; i < kInputs; ++i)
    sum += model.weights[static_cast<std::size_t>(i)] * inputs[static_cast<std::size_t>(i)];
  return 1 / (1 + std::exp(-sum));
}

}  // namespace

Presence rate_presence(const PresenceEvidence& evidence) {
  const Inputs inputs = inputs_of(evidence);
  return {evaluate(kObject, inputs), evaluate(kPlace, inputs)};
}

double least_probability(double false_alarms_per_1000_images) {
  const double odds = std::pow(false_alarms_per_1000_images / kDial.at_even_odds, -kDial.steepness);
  return odds / (1 + odds);
}

}  // namespace posevote
