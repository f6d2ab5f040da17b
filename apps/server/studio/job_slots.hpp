// So many computations at once, the others wait.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

#include "http/problem.hpp"

namespace posevote::server {

class JobSlots {
 public:
  JobSlots(int slots, double wait_s) : free_(slots), wait_s_(wait_s) {}

  /// A place among those who compute, as long as it lives.
  class Slot {
   public:
    /// Throws Problem 503 when no place gets free in time.
    explicit Slot(JobSlots& of) : of_(of) {
      std::unique_lock lock(of_.mutex_);
      const std::chrono::duration<double> time(of_.wait_s_);
      if (!of_.freed_.wait_for(lock, time, [&] { return of_.free_ > 0; })) throw busy();
      --of_.free_;
    }
    ~Slot() {
      {
        const std::lock_guard lock(of_.mutex_);
        ++of_.free_;
      }
      of_.freed_.notify_one();
    }
    Slot(const Slot&) = delete;
    Slot& operator=(const Slot&) = delete;

   private:
    JobSlots& of_;
  };

 private:
  std::mutex mutex_;
  std::condition_variable freed_;
  int free_;
  double wait_s_;
};

}  // namespace posevote::server
