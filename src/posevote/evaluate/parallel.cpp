#include "posevote/evaluate/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace posevote {

int thread_count(int jobs) {
  if (jobs > 0) return jobs;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void parallel_for(std::size_t count, int jobs, const std::function<void(std::size_t)>& work,
                  const Progress& progress) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stop{false};
  std::mutex mutex;
  std::exception_ptr failure;
  std::size_t failed_at = count;
  std::size_t done = 0;

  const auto run = [&] {
    for (std::size_t i = next++; i < count && !stop; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        stop = true;
        if (i >= failed_at) continue;
        failed_at = i;
        failure = std::current_exception();
        continue;
      }
      const std::lock_guard lock(mutex);
      ++done;
      if (progress) progress(done, count);
    }
  };

  const auto threads = std::min(count, static_cast<std::size_t>(thread_count(jobs)));
  {
    std::vector<std::jthread> helpers;
    for (std::size_t i = 1; i < threads; ++i) helpers.emplace_back(run);
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace posevote
