// Line charts as SVG, drawn with the colours of the page that holds them.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace posevote {

struct ChartSeries {
  std::string name;
  std::vector<cv::Point2d>
      points;  ///< joined in this order; points that are not finite are left out
};

struct ChartAxis {
  std::string label;
  double min = 0, max = 0;  ///< min >= max: the range of the points
};

struct Chart {
  std::string title;
  ChartAxis x, y;
  std::vector<ChartSeries> series;

  /// An <svg> element for HTML. It uses the classes chart, grid, tick, label and s0..s5 (one for
  /// each series, then again from s0), for which `chart_style` has the rules. Every point has its
  /// values as a tooltip.
  [[nodiscard]] std::string to_svg() const;
};

/// A share with its confidence interval.
struct IntervalRow {
  std::string name;
  double value = 0, low = 0, high = 1;
};

/// One dot with whiskers per row on an axis from 0 to 100 %.
[[nodiscard]] std::string interval_svg(const std::string& title,
                                       const std::vector<IntervalRow>& rows);

/// Style rules for both, for light and dark pages and for print.
[[nodiscard]] const char* chart_style();

/// About `count` round numbers that cover [min, max].
[[nodiscard]] std::vector<double> round_ticks(double min, double max, int count);

}  // namespace posevote
