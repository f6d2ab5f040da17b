#include "posevote/verify/presence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace posevote {
namespace {

constexpr int kInputs = 12;
using Inputs = std::array<double, kInputs>;

struct Model {
  double bias;
  Inputs weights;
};

// Fitted on the development sets: bench/calibrate_presence.py says how, and prints these lines.
constexpr Model kObject{
    -17.18,
    {1.343, 0.000, 7.106, 3.385, 4.326, -12.814, 8.563, 0.000, 1.807, 11.684, 0.000, -0.896}};
constexpr Model kPlace{
    -5.05, {0.692, 0.000, 3.549, 1.504, 0.000, 0.000, 0.264, 5.499, -0.633, 0.000, 3.201, 0.720}};

/// Fitted to what the same script says of sets left out. False detections per 1000 pictures at odds
/// o of the least probability: at_even_odds * o ^ (-1 / steepness).
struct Dial {
  double at_even_odds, steepness;
};
constexpr Dial kDial{28, 1.82};

/// What a view without a patch is credited with: the lower quartile of right detections.
constexpr Agreement kUnknown{0.54, 0.8, 0.115, 0.48, 1};

Inputs inputs_of(const PresenceEvidence& evidence) {
  const Agreement& agreement = evidence.agreement.visible > 0 ? evidence.agreement : kUnknown;
  return {std::log10(1 + std::max(0.0, evidence.digits)),
          std::log(evidence.confidence + 0.01),
          std::sqrt(evidence.coverage),
          agreement.structure,
          agreement.structure_near_matches,
          agreement.colour_difference,
          agreement.visible,
          agreement.rim,
          evidence.distortion * (1 - evidence.coverage),
          std::sqrt(evidence.found),
          std::max(0.0, evidence.consensus),
          evidence.consensus < 0 ? 1.0 : 0.0};
}

double log_odds(const Model& model, const Inputs& inputs) {
  return std::inner_product(inputs.begin(), inputs.end(), model.weights.begin(), model.bias);
}

}  // namespace

Presence rate_presence(const PresenceEvidence& evidence) {
  const Inputs inputs = inputs_of(evidence);
  return {log_odds(kObject, inputs), log_odds(kPlace, inputs)};
}

double least_probability(double false_alarms_per_1000_images) {
  const double odds = std::pow(false_alarms_per_1000_images / kDial.at_even_odds, -kDial.steepness);
  return odds / (1 + odds);
}

}  // namespace posevote
