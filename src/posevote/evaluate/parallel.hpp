// A loop whose turns run on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace posevote {

/// Called after each finished piece of work, never by two threads at once.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

/// Threads for `jobs` as users give it: 0 means one for each core.
[[nodiscard]] int thread_count(int jobs);

/// Calls `work(i)` for i in [0, count), each once, on `jobs` threads (0: one for each core). When
/// calls throw, the exception of the lowest i that threw is thrown again after all threads ended;
/// no new turns are begun after the first.
void parallel_for(std::size_t count, int jobs, const std::function<void(std::size_t)>& work,
                  const Progress& progress = {});

}  // namespace posevote
