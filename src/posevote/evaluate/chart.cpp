#include "posevote/evaluate/chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "posevote/evaluate/table.hpp"

namespace posevote {
namespace {

constexpr double width = 560, height = 330;
constexpr double left = 62, right = 16, top = 48, bottom = 48;
constexpr int series_colours = 6;

std::string px(double value) {
  return fixed(value, 1);
}

std::string tick_text(double value, double step) {
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
  return fixed(value == 0 ? 0 : value, decimals);
}

std::string text(double x, double y, const std::string& css, const std::string& anchor,
                 const std::string& content, const std::string& more = "") {
  return "<text x=\"" + px(x) + "\" y=\"" + px(y) + "\" class=\"" + css + "\" text-anchor=\"" +
         anchor + "\"" + more + ">" + escape_html(content) + "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, const std::string& css) {
  return "<line x1=\"" + px(x1) + "\" y1=\"" + px(y1) + "\" x2=\"" + px(x2) + "\" y2=\"" + px(y2) +
         "\" class=\"" + css + "\"/>\n";
}

std::string open_svg(const std::string& title, double svg_height) {
  return "<svg class=\"chart\" role=\"img\" viewBox=\"0 0 " + px(width) + " " + px(svg_height) +
         "\" aria-label=\"" + escape_html(title) + "\">\n";
}

bool is_finite(const cv::Point2d& point) {
  return std::isfinite(point.x) && std::isfinite(point.y);
}

ChartAxis with_range(ChartAxis axis, const std::vector<ChartSeries>& series,
                     double cv::Point2d::*coordinate) {
  if (axis.min < axis.max) return axis;
  axis.min = std::numeric_limits<double>::infinity();
  axis.max = -axis.min;
  for (const ChartSeries& one : series)
    for (const cv::Point2d& point : one.points) {
      if (!is_finite(point)) continue;
      axis.min = std::min(axis.min, point.*coordinate);
      axis.max = std::max(axis.max, point.*coordinate);
    }
  if (!(axis.min <= axis.max)) axis.min = axis.max = 0;
  if (axis.min == axis.max) axis.max = axis.min + 1;
  return axis;
}

class Plot {
 public:
  Plot(const ChartAxis& x, const ChartAxis& y) : x_(x), y_(y) {}

  [[nodiscard]] double map_x(double value) const {
    return left + (value - x_.min) / (x_.max - x_.min) * (width - left - right);
  }
  [[nodiscard]] double map_y(double value) const {
    return height - bottom - (value - y_.min) / (y_.max - y_.min) * (height - top - bottom);
  }
  [[nodiscard]] std::string axes() const {
    std::string svg;
    const auto xs = round_ticks(x_.min, x_.max, 7), ys = round_ticks(y_.min, y_.max, 6);
    for (const double x : xs)
      svg += line(map_x(x), top, map_x(x), height - bottom, "grid") +
             text(map_x(x), height - bottom + 16, "tick", "middle", tick_text(x, step_of(xs)));
    for (const double y : ys)
      svg += line(left, map_y(y), width - right, map_y(y), "grid") +
             text(left - 6, map_y(y) + 4, "tick", "end", tick_text(y, step_of(ys)));
    const double middle = (top + height - bottom) / 2;
    return svg + text((left + width - right) / 2, height - 10, "label", "middle", x_.label) +
           text(14, middle, "label", "middle", y_.label,
                " transform=\"rotate(-90 14 " + px(middle) + ")\"");
  }
  [[nodiscard]] std::string curve(const ChartSeries& series, const std::string& colour) const {
    std::string path, dots;
    for (const cv::Point2d& point : series.points) {
      if (!is_finite(point)) continue;
      const double x = map_x(std::clamp(point.x, x_.min, x_.max));
      const double y = map_y(std::clamp(point.y, y_.min, y_.max));
      path += (path.empty() ? "" : " ") + px(x) + "," + px(y);
      dots += "<circle cx=\"" + px(x) + "\" cy=\"" + px(y) + "\" r=\"2.5\"><title>" +
              escape_html(series.name) + ": " + fixed(point.x, 3) + ", " + fixed(point.y, 3) +
              "</title></circle>\n";
    }
    return "<g class=\"" + colour + "\"><polyline points=\"" + path + "\"/>\n" + dots + "</g>\n";
  }

 private:
  static double step_of(const std::vector<double>& ticks) {
    return ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
  }
  ChartAxis x_, y_;
};

}  // namespace

std::vector<double> round_ticks(double min, double max, int count) {
  if (!(min < max) || count < 1) return {min};
  const double raw = (max - min) / count;
  const double power = std::pow(10, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0})
    if (factor * power >= raw * (1 - 1e-9)) step = factor * power;
  std::vector<double> ticks;
  const double first = std::ceil(min / step - 1e-9), last = std::floor(max / step + 1e-9);
  for (int i = 0; i <= last - first; ++i) ticks.push_back((first + i) * step);
  return ticks;
}

std::string Chart::to_svg() const {
  const Plot plot(with_range(x, series, &cv::Point2d::x), with_range(y, series, &cv::Point2d::y));
  std::string svg = open_svg(title, height) + text(left, 18, "title", "start", title) + plot.axes();
  double legend_x = left;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const std::string colour = "s" + std::to_string(i % series_colours);
    svg += plot.curve(series[i], colour);
    if (series.size() < 2) continue;
    svg += "<g class=\"" + colour + "\">" +
           text(legend_x, 36, "legend", "start", "\u25CF " + series[i].name) + "</g>\n";
    legend_x += 7.0 * static_cast<double>(series[i].name.size()) + 30;
  }
  return svg + "</svg>\n";
}

std::string interval_svg(const std::string& title, const std::vector<IntervalRow>& rows) {
  constexpr double row_height = 22, names = 170, first = 34;
  const double end = first + row_height * static_cast<double>(rows.size());
  const auto map_x = [&](double share) { return names + share * (width - names - right - 64); };
  std::string svg = open_svg(title, end + 24) + text(8, 18, "title", "start", title);
  for (int tick = 0; tick <= 100; tick += 20)
    svg += line(map_x(tick / 100.0), first - 4, map_x(tick / 100.0), end, "grid") +
           text(map_x(tick / 100.0), end + 16, "tick", "middle", std::to_string(tick) + " %");
  double y = first + row_height / 2;
  for (const IntervalRow& row : rows) {
    svg += text(names - 10, y + 4, "label", "end", row.name);
    if (std::isfinite(row.value)) {
      svg += "<g class=\"s0\">" + line(map_x(row.low), y, map_x(row.high), y, "whisker") +
             "<circle cx=\"" + px(map_x(row.value)) + "\" cy=\"" + px(y) + "\" r=\"4.5\"/></g>\n" +
             text(width - right, y + 4, "tick", "end", percent(row.value));
    }
    y += row_height;
  }
  return svg + "</svg>\n";
}

const char* chart_style() {
  return R"(.chart{width:100%;max-width:640px;height:auto;display:block;margin:.5rem 0}
.chart text{fill:var(--ink);font:12px system-ui,sans-serif}
.chart .title{font-weight:600;font-size:13px}
.chart .tick{fill:var(--soft);font-size:11px}
.chart .grid{stroke:var(--line);stroke-width:1}
.chart polyline{fill:none;stroke-width:2;stroke-linejoin:round}
.chart .whisker{stroke-width:3;stroke-opacity:.45;stroke-linecap:round}
.s0{--c:var(--c0)}.s1{--c:var(--c1)}.s2{--c:var(--c2)}
.s3{--c:var(--c3)}.s4{--c:var(--c4)}.s5{--c:var(--c5)}
.chart polyline,.chart .whisker{stroke:var(--c)}
.chart circle,.chart .legend{fill:var(--c)}
)";
}

}  // namespace posevote
