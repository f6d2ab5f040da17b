// Curves over the number of taught descriptors, as an SVG picture.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace posevote::bench {

struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< (x, y), both greater than 0
};

struct Panel {
  std::string title;  ///< with the unit of y
  std::vector<Curve> curves;
};

/// Panels side by side, both axes logarithmic, one legend for all: equal names have equal colours.
[[nodiscard]] std::string plot_svg(const std::string& x_title, const std::vector<Panel>& panels);

}  // namespace posevote::bench
