#include "app/figure.hpp"

#include "app/gnuplot.hpp"
#include "app/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace verification {
namespace {

// Curves of a panel as gnuplot data blocks $p<panel>c<curve>.
std::string data_blocks(const Figure& figure) {
  std::string text;
  for (std::size_t p = 0; p < figure.panels.size(); ++p)
    for (std::size_t c = 0; c < figure.panels[p].curves.size(); ++c) {
      const Curve& curve = figure.panels[p].curves[c];
      text += fmt::format("$p{}c{} << EOD\n", p, c);
      for (std::size_t k = 0; k < curve.x.size(); ++k) {
        text += fmt::format("{:.8g} {:.8g}", curve.x[k], curve.y[k]);
        if (!curve.low.empty()) text += fmt::format(" {:.8g} {:.8g}", curve.low[k], curve.high[k]);
        text += "\n";
      }
      text += "EOD\n";
    }
  return text;
}

std::string stroke(const Curve& curve) {
  const double width = curve.stroke == Stroke::thin ? 1.2 : 2.2;
  return fmt::format("lc rgb '{}' lw {} dt {}", curve.colour, width,
                     curve.stroke == Stroke::dashed ? "(8,5)" : "solid");
}

std::string style(const Curve& curve) {
  const bool line = curve.stroke != Stroke::none;
  if (curve.marker == 0) return "lines " + stroke(curve);
  return fmt::format("{} {} pt {} ps 1", line ? "linespoints" : "points",
                     line ? stroke(curve) : fmt::format("lc rgb '{}' lw 1.8", curve.colour),
                     curve.marker);
}

std::string plot_command(const Panel& panel, std::size_t number) {
  std::vector<std::string> items;
  for (std::size_t c = 0; c < panel.curves.size(); ++c) {
    const Curve& curve = panel.curves[c];
    if (!curve.low.empty())
      items.insert(
          items.begin(),
          fmt::format("$p{}c{} using 1:3:4 with filledcurves fs transparent solid 0.2 noborder lc "
                      "rgb '{}' notitle",
                      number, c, curve.colour));
    items.push_back(fmt::format(
        "$p{}c{} using 1:2 with {} {}", number, c, style(curve),
        curve.title.empty() ? "notitle" : "title " + gnuplot_text(curve.title) + " noenhanced"));
  }
  return fmt::format("plot {}\n", fmt::join(items, ", "));
}

// Tick format: powers of ten where plain numbers would be too long.
std::string log_format(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return values.empty() || (*low >= 1e-2 && *high <= 1e5) ? "%g" : "10^{%T}";
}

std::string log_commands(const Figure& figure, const Panel& panel) {
  std::vector<double> ys;
  for (const Curve& curve : panel.curves) ys.insert(ys.end(), curve.y.begin(), curve.y.end());
  return std::string(figure.logarithmic ? "set logscale x\n" : "unset logscale x\n") +
         (panel.logarithmic ? "set logscale y\nset format y '" + log_format(ys) + "'\n"
                            : std::string("unset logscale y\nset format y '% h'\n"));
}

// Range of all panels' abscissae; logarithmic ones with a margin for markers.
std::string common_range(const Figure& figure) {
  constexpr double room = 1.25;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Panel& panel : figure.panels)
    for (const Curve& curve : panel.curves)
      for (const double x : curve.x) {
        low = std::min(low, x);
        high = std::max(high, x);
      }
  if (low == high && !figure.logarithmic) {  // gnuplot warns about an empty range
    const double around = low != 0 ? 0.1 * std::abs(low) : 1;
    low -= around;
    high += around;
  }
  if (!(high > low)) return "";
  if (!figure.logarithmic) {
    const double margin = figure.room * (high - low);
    return fmt::format("set xrange [{}:{}]\n", low - margin, high + margin);
  }
  return high > 0 ? fmt::format("set xrange [{}:{}]\n", low / room, high * room) : "";
}

// Range of gnuplot, or one around a constant, about which it would warn.
std::string range_command(const Panel& panel) {
  if (panel.logarithmic && panel.lowest > 0)
    return fmt::format("set yrange [{}:*]\n", panel.lowest);
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Curve& curve : panel.curves)
    for (const double y : curve.y) {
      low = std::min(low, y);
      high = std::max(high, y);
    }
  if (high - low > 1e-9 * std::max(std::abs(low), std::abs(high))) return "set yrange [*:*]\n";
  return fmt::format("set yrange [{}:{}]\n", low - 1, high + 1);
}

// Number of characters of UTF-8.
std::size_t letters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  }));
}

constexpr int width = 900;  // width of a picture [points]

// Lines of the legend above a panel, in columns as wide as the longest entry.
int legend_lines(const Panel& panel, double left) {
  constexpr double letter = 10, sample = 62;  // points
  std::size_t longest = 0, entries = 0;
  for (const Curve& curve : panel.curves) {
    if (curve.title.empty()) continue;
    ++entries;
    longest = std::max(longest, letters(curve.title));
  }
  if (entries == 0) return 0;
  const double column = letter * static_cast<double>(longest) + sample;
  const auto columns = static_cast<std::size_t>(std::max(1.0, (0.97 - left) * width / column));
  return static_cast<int>((entries + columns - 1) / columns);
}

}  // namespace

bool draw(const Figure& figure, const std::filesystem::path& stem) {
  constexpr double row = 21;                              // line of a legend [points]
  const double left = figure.logarithmic ? 0.135 : 0.12;  // powers of ten are wide
  const auto count = static_cast<double>(figure.panels.size());
  const double relative =
      std::accumulate(figure.panels.begin(), figure.panels.end(), 0.0,
                      [](double sum, const Panel& panel) { return sum + panel.height; });
  std::vector<int> legends;
  int lines = 0;
  for (const Panel& panel : figure.panels) {
    legends.push_back(legend_lines(panel, left));
    lines += legends.back();
  }
  const double height = 150 + 270 * relative + row * lines;
  const double gap = 20 / height;
  const double top = 1 - (figure.title.empty() ? 14 : 38) / height;
  const double bottom = 76 / height;  // margin for the abscissa
  const double unit = (top - bottom - gap * (count - 1) - row * lines / height) / relative;

  std::string body = data_blocks(figure);
  body +=
      "set multiplot\n"
      "set border 3 lc rgb '#555555'\nset tics out nomirror scale 0.6 tc rgb '#333333'\n"
      "set grid lc rgb '#e4e4e4' lw 1 dt solid\n"
      "set rmargin at screen 0.97\nset autoscale xfix\n";
  body += fmt::format("set lmargin at screen {}\n", left);
  body += common_range(figure);
  if (!figure.title.empty())
    body += fmt::format("set label 1 {} at screen {},{:.4f} left noenhanced\n",
                        gnuplot_text(figure.title), left, 1 - 18 / height);
  double upper = top;
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    const Panel& panel = figure.panels[p];
    const double legend = upper - 2 / height;  // upper edge of the legend
    upper -= row * legends[p] / height;
    const double lower = upper - unit * panel.height;
    body +=
        fmt::format("set tmargin at screen {:.4f}\nset bmargin at screen {:.4f}\n", upper, lower);
    body += fmt::format("set label 2 {} at screen 0.02,{:.4f} center rotate by 90 noenhanced\n",
                        gnuplot_text(panel.ordinate), 0.5 * (upper + lower));
    body += legends[p] > 0
                ? fmt::format(
                      "set key at screen 0.97,{:.4f} right top horizontal Left reverse maxrows {} "
                      "samplen 2.5 spacing 1.1 noautotitle\n",
                      legend, legends[p])
                : std::string("unset key\n");
    body += log_commands(figure, panel);
    body += range_command(panel);
    const bool last = p + 1 == figure.panels.size();
    body += last ? fmt::format("set format x '%g'\nset xlabel {} noenhanced\n",
                               gnuplot_text(figure.abscissa))
                 : std::string("set format x ''\nunset xlabel\n");
    body += plot_command(panel, p) + "unset label 1\n";
    upper = lower - gap;
  }
  body += "unset multiplot\n";
  return run_gnuplot(body, stem, width, static_cast<int>(height));
}

}  // namespace verification
