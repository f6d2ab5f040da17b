// What a person who teaches wants to know: will this be found, and what is it mixed up with?
#pragma once

#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "posevote/model/model_set.hpp"
#include "posevote/teach/quality.hpp"

namespace posevote::cli {

/// A table with a row for each of `views` (with pictures), then the advice. `all`: every view of
/// the object.
void print_quality(const std::vector<std::shared_ptr<const View>>& views,
                   const std::vector<std::shared_ptr<const View>>& all,
                   const QualityOptions& options, std::ostream& out);

/// A line for each other object of `models` that is found on one of `views` of `name`.
void print_resemblances(const std::string& name,
                        const std::vector<std::shared_ptr<const View>>& views,
                        const ModelSet& models, const FeatureOptions& features, std::ostream& out);

}  // namespace posevote::cli
