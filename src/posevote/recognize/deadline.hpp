// How much of a time budget is spent.
#pragma once

#include <chrono>

namespace posevote {

class Deadline {
 public:
  /// Begins now; 0 ms: there is none.
  explicit Deadline(double budget_ms) : budget_ms_(budget_ms) {}

  [[nodiscard]] bool limited() const noexcept { return budget_ms_ > 0; }
  /// Is that share of the budget spent?
  [[nodiscard]] bool passed(double share) const {
    const std::chrono::duration<double, std::milli> spent = Clock::now() - start_;
    return limited() && spent.count() >= share * budget_ms_;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  double budget_ms_;
};

}  // namespace posevote
