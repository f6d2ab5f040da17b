// What the views of one object say together of the place where each of them was found.
#pragma once

#include <vector>

#include "posevote/model/model_set.hpp"
#include "posevote/verify/verifier.hpp"

namespace posevote {

/// Sets `measured.consensus` of every hypothesis that was not rejected: the mean overlap of its box
/// with the boxes of the other views' hypotheses in that place (overlap above 0.2), weighted by
/// their numbers of inliers. A pose that only one view supports, or that each view puts elsewhere,
/// is less to be trusted than one on which neighbouring views agree.
void measure_consensus(std::vector<Hypothesis>& hypotheses, const ModelSet& models);

}  // namespace posevote
