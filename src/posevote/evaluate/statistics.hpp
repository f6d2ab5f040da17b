// The few statistics that tables need.
#pragma once

#include <vector>

namespace posevote {

struct Interval {
  double low = 0, high = 1;
};

/// Wilson's score interval of a share of `hits` among `trials`; `z` = 1.96 covers 95 %.
/// No trials: [0, 1].
[[nodiscard]] Interval wilson_interval(int hits, int trials, double z = 1.959963984540054);

/// The value below which a share `p` (0..1) of `values` lies, interpolated linearly between order
/// statistics; NaN when there are none.
[[nodiscard]] double quantile(std::vector<double> values, double p);

[[nodiscard]] inline double median(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

}  // namespace posevote
