// Which taught objects look alike: variants of one pack, or one thing taught under two names.
#pragma once

#include <memory>
#include <vector>

#include "posevote/index/index.hpp"
#include "posevote/model/model_set.hpp"

namespace posevote {

/// Pairs of objects that look alike; the parameter `related` of `Neighborhood` is its table.
struct LookAlikes {
  std::shared_ptr<const ModelSet> models;
  std::vector<char> table;  ///< a * objects + b is 1 when a and b look alike; symmetric
};

/// Two objects look alike when a good part of the features of one of them is found on the other,
/// much nearer than on any third. Looks at a sample of each object's features; `index` holds
/// `models`. Of objects that are in `before` with the same views, only new partners are looked for.
[[nodiscard]] LookAlikes find_look_alikes(const std::shared_ptr<const ModelSet>& models,
                                          const Index& index, const LookAlikes* before = nullptr);

/// For each view of the models a number that it shares with the other views of its object and, by
/// `table` (empty: none), of all look-alikes, and of their look-alikes: `groups` of
/// `Index::search_rivals`.
[[nodiscard]] std::vector<int> group_views(const ModelSet& models, const std::vector<char>& table);

}  // namespace posevote
