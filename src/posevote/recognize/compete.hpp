// Hypotheses compete for the scene's features: each physical instance is reported once.
#pragma once

#include <vector>

#include "posevote/recognize/recognizer.hpp"

namespace posevote {

/// Keeps the accepted hypotheses, best first, such that every scene feature speaks for one of them
/// only. A hypothesis that needs features already explained by a better one is judged again without
/// them, and one of the same object at the same place (boxes overlap by more than `max_overlap`) is
/// dropped. Of two objects that look alike the parts in which they differ decide; a hypothesis for
/// which they do not names the other in `alternatives`.
[[nodiscard]] std::vector<Hypothesis> compete(std::vector<Hypothesis> hypotheses,
                                              const SceneContext& scene,
                                              const RecognizeOptions& options);

}  // namespace posevote
