#include "scale_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <vector>

namespace posevote::bench {
namespace {

constexpr double kWidth = 400, kHeight = 300, kLeft = 62, kTop = 34, kGap = 24, kBottom = 46;
constexpr double kLegendLine = 18;
constexpr std::array kColours = {"#0b6e99", "#d1495b", "#66a182", "#edae49", "#7d5ba6",
                                 "#8d6a4f", "#2e4057", "#c06c84", "#5a9367"};

/// A logarithmic axis over whole decades.
struct Axis {
  double low = 1e300, high = 0;
  void take(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  void round() {
    low = std::pow(10, std::floor(std::log10(low)));
    high = std::pow(10, std::ceil(std::log10(high)));
    if (high <= low) high = 10 * low;
  }
  [[nodiscard]] std::vector<double> powers_of_ten() const {
    std::vector<double> powers{low};
    while (powers.back() * 10 <= high * 1.01) powers.push_back(powers.back() * 10);
    return powers;
  }
  [[nodiscard]] double share(double v) const { return std::log(v / low) / std::log(high / low); }
};

std::string number(double v) {
  std::ostringstream text;
  if (v >= 1e6)
    text << v / 1e6 << " M";
  else if (v >= 1e3)
    text << v / 1e3 << " k";
  else
    text << v;
  return text.str();
}

void text(std::ostream& out, double x, double y, const std::string& anchor,
          const std::string& what) {
  out << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << anchor << "\">" << what
      << "</text>\n";
}

void line(std::ostream& out, double x1, double y1, double x2, double y2,
          const std::string& colour) {
  out << "<line x1=\"" << x1 << "\" y1=\"" << y1 << "\" x2=\"" << x2 << "\" y2=\"" << y2
      << "\" stroke=\"" << colour << "\"/>\n";
}

void draw_axes(std::ostream& out, const Panel& panel, const std::string& x_title, const Axis& x,
               const Axis& y) {
  text(out, 0, -12, "start", panel.title);
  text(out, kWidth / 2, kHeight + 38, "middle", x_title);
  for (const double v : x.powers_of_ten()) {
    line(out, kWidth * x.share(v), 0, kWidth * x.share(v), kHeight, "#ddd");
    text(out, kWidth * x.share(v), kHeight + 18, "middle", number(v));
  }
  for (const double v : y.powers_of_ten()) {
    const double height = kHeight * (1 - y.share(v));
    line(out, 0, height, kWidth, height, "#ddd");
    text(out, -8, height + 4, "end", number(v));
  }
}

void draw_curve(std::ostream& out, const Curve& curve, const char* colour, const Axis& x,
                const Axis& y) {
  std::ostringstream path, dots;
  for (const auto& [at, value] : curve.points) {
    const double px = kWidth * x.share(at), py = kHeight * (1 - y.share(value));
    path << px << ',' << py << ' ';
    dots << "<circle cx=\"" << px << "\" cy=\"" << py << "\" r=\"3\" fill=\"" << colour << "\"/>\n";
  }
  out << "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"" << colour << "\" points=\""
      << path.str() << "\"/>\n"
      << dots.str();
}

}  // namespace

std::string plot_svg(const std::string& x_title, const std::vector<Panel>& panels) {
  std::vector<std::string> names;
  for (const Panel& panel : panels)
    for (const Curve& curve : panel.curves)
      if (std::ranges::find(names, curve.name) == names.end()) names.push_back(curve.name);
  const double panel_width = kLeft + kWidth + kGap;
  const double width = panel_width * static_cast<double>(panels.size());
  const double legend_top = kTop + kHeight + kBottom;
  const double height = legend_top + kLegendLine * (1 + static_cast<double>(names.size()));
  std::ostringstream out;
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << width << "\" height=\"" << height
      << "\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\">\n"
      << "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  const auto colour = [&](const std::string& name) {
    const auto place = std::ranges::find(names, name) - names.begin();
    return kColours[static_cast<std::size_t>(place) % kColours.size()];
  };
  for (std::size_t p = 0; p < panels.size(); ++p) {
    Axis x, y;
    for (const Curve& curve : panels[p].curves)
      for (const auto& [at, value] : curve.points) {
        x.take(at);
        y.take(value);
      }
    x.round();
    y.round();
    out << "<g transform=\"translate(" << panel_width * static_cast<double>(p) + kLeft << ' '
        << kTop << ")\">\n";
    draw_axes(out, panels[p], x_title, x, y);
    for (const Curve& curve : panels[p].curves) draw_curve(out, curve, colour(curve.name), x, y);
    out << "</g>\n";
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double y = legend_top + kLegendLine * (static_cast<double>(i) + 1);
    out << "<rect x=\"" << kLeft << "\" y=\"" << y - 9 << "\" width=\"16\" height=\"9\" fill=\""
        << colour(names[i]) << "\"/>\n";
    text(out, kLeft + 24, y, "start", names[i]);
  }
  out << "</svg>\n";
  return out.str();
}

}  // namespace posevote::bench
