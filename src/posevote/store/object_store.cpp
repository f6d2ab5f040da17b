#include "posevote/store/object_store.hpp"

#include <algorithm>
#include <thread>

namespace posevote {

bool ObjectStore::wait_for_change(std::int64_t known, std::chrono::milliseconds timeout) const {
  using Clock = std::chrono::steady_clock;
  constexpr Clock::duration between = std::chrono::milliseconds(100);
  const Clock::time_point end = Clock::now() + timeout;
  while (version() == known) {
    const Clock::duration left = end - Clock::now();
    if (left <= Clock::duration::zero()) return false;
    std::this_thread::sleep_for(std::min(left, between));
  }
  return true;
}

}  // namespace posevote
