// One search: which codes are compared with which queries, and in which order.
#pragma once

#include <cstddef>

#include "posevote/index/list_index.hpp"

namespace posevote {

/// Finds the neighbours of rows [begin, end) of the scene. What is found for a row does not depend
/// on the others.
void search_rows(const ListIndex& index, const Features& scene, std::size_t k,
                 const std::vector<int>* groups, std::size_t begin, std::size_t end,
                 NeighborLists& result);

}  // namespace posevote
