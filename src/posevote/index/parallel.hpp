// Splits work over threads.
#pragma once

#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace posevote {

/// Calls work(begin, end) for about equal parts of [0, count), each on a thread of its own; at once
/// when one thread is enough. The first exception of any part is thrown again.
template <class Work>
void parallel(int threads, std::size_t count, const Work& work) {
  const std::size_t parts = threads > 1 ? static_cast<std::size_t>(threads) : 1;
  if (parts == 1 || count <= 1) {
    work(std::size_t{0}, count);
    return;
  }
  std::vector<std::exception_ptr> errors(parts);
  const auto run = [&](std::size_t part) {
    try {
      work(count * part / parts, count * (part + 1) / parts);
    } catch (...) {
      errors[part] = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t part = 1; part < parts; ++part) others.emplace_back(run, part);
    run(0);
  }
  for (const auto& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace posevote
