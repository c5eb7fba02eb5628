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

// The curves of a panel as gnuplot data blocks $p<panel>c<curve>.
std::string data_blocks(const Figure& figure) {
  std::string text;
  for (std::size_t p = 0; p < figure.panels.size(); ++p)
    for (std::size_t c = 0; c < figure.panels[p].curves.size(); ++c) {
      const Curve& curve = figure.panels[p].curves[c];
      text += fmt::format("$p{}c{} << EOD\n", p, c);
      for (std::size_t k = 0; k < curve.x.size(); ++k) {
        text += fmt::format("{:.8g} {:.8g}", curve.x[k], curve.y[k]);
        if (!curve.low.empty()) text += fmt::format(" {:.8g} {:.8g}", curve.low[k], curve.high[k]);
        if (!curve.cycles.empty()) text += fmt::format(" {}", curve.cycles[k]);
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
    if (!curve.cycles.empty()) {
      items.push_back(
          fmt::format("$p{}c{} using 1:2:3 with lines lw 1.4 lc palette notitle", number, c));
      continue;
    }
    items.push_back(fmt::format(
        "$p{}c{} using 1:2 with {} {}", number, c, style(curve),
        curve.title.empty() ? "notitle" : "title " + gnuplot_text(curve.title) + " noenhanced"));
  }
  return fmt::format("plot {}\n", fmt::join(items, ", "));
}

// Powers of ten where plain numbers would be too long to read.
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

// Numbers that an axis labelled with six digits does not tell apart.
bool alike(double low, double high) {
  return high - low <= 1e-6 * std::max(std::abs(low), std::abs(high));
}

// Abscissae of all panels; logarithmic ones with room for the markers at the ends.
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
  if (alike(low, high) && !figure.logarithmic) {  // gnuplot would complain of it
    const double around = low != 0 ? 0.1 * std::abs(low) : 1;
    low -= around;
    high += around;
  }
  if (!(high > low)) return "";
  if (!figure.logarithmic) {
    const double margin = figure.room * (high - low);
    return fmt::format("set xrange [{}:{}]\n", low - margin, high + margin);
  }
  if (!(high > 0)) return "";
  std::string numbers;  // between powers of ten, where there are few of these
  for (double ten = std::pow(10, std::floor(std::log10(low / room))); ten <= high * room; ten *= 10)
    for (const double digit : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0})
      numbers += fmt::format("{}{:g}", numbers.empty() ? "" : ",", digit * ten);
  return fmt::format("set xrange [{}:{}]\n", low / room, high * room) +
         (low > 0 && high < 10 * low ? fmt::format("set xtics ({})\n", numbers) : "");
}

// Gnuplot's own range, or one around a constant, of which it would complain.
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
  if (!alike(low, high)) return "set yrange [*:*]\n";
  return fmt::format("set yrange [{}:{}]\n", low - 1, high + 1);
}

// Counts letters of a text in UTF-8.
std::size_t letters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  }));
}

constexpr int width = 900;          // of a picture [points]
constexpr double letter_wide = 10;  // of its text

// The last of the cycles that colours tell; 0: none.
int last_cycle(const Figure& figure) {
  int last = 0;
  for (const Panel& panel : figure.panels)
    for (const Curve& curve : panel.curves)
      for (const int cycle : curve.cycles) last = std::max(last, cycle);
  return last;
}

// A scale of colours beside the panels, between two heights of the screen.
std::string colour_scale(int last, double lower, double upper) {
  const double high = std::min(upper - lower - 0.06, 0.6);
  return fmt::format(
      "set palette defined (0 '#30123b', 0.3 '#0072b2', 0.65 '#009e73', 1 '#e69f00')\n"
      "set cbrange [1:{}]\nset cbtics {} format '%g'\n"
      "set label 3 'cycle [-]' at screen 0.88,{:.4f} left\n"
      "set colorbox user origin screen 0.88,{:.4f} size screen 0.015,{:.4f} border\n",
      last, last <= 10 ? "1" : "autofreq", lower + high + 0.04, lower, high);
}

// An ordinate in as many lines as its panel is high [points].
std::string ordinate_lines(const std::string& text, double height) {
  const std::size_t comma = text.find(", ");
  const bool fits = letter_wide * static_cast<double>(letters(text)) <= height;
  return fits || comma == std::string::npos
             ? text
             : text.substr(0, comma + 1) + "\n" + text.substr(comma + 2);
}

// Lines that the legend of a panel takes above it, where it lies on no curve; entries in columns as wide as
// the longest of them.
int legend_lines(const Panel& panel, double left, double right) {
  constexpr double sample = 62;  // points
  std::size_t longest = 0, entries = 0;
  for (const Curve& curve : panel.curves) {
    if (curve.title.empty()) continue;
    ++entries;
    longest = std::max(longest, letters(curve.title));
  }
  if (entries == 0) return 0;
  const double column = letter_wide * static_cast<double>(longest) + sample;
  const auto columns = static_cast<std::size_t>(std::max(1.0, (right - left) * width / column));
  return static_cast<int>((entries + columns - 1) / columns);
}

}  // namespace

bool draw(const Figure& figure, const std::filesystem::path& stem) {
  constexpr double row = 21, below_legend = 8;  // of a legend [points]
  constexpr double left = 0.14;
  const int cycles = last_cycle(figure);
  const double right = cycles > 0 ? 0.86 : 0.97;
  const auto count = static_cast<double>(figure.panels.size());
  const double relative =
      std::accumulate(figure.panels.begin(), figure.panels.end(), 0.0,
                      [](double sum, const Panel& panel) { return sum + panel.height; });
  std::vector<int> legends;
  for (const Panel& panel : figure.panels) {
    legends.push_back(legend_lines(panel, left, right));
  }
  double legend_height = 0;
  for (const int lines : legends) legend_height += lines > 0 ? row * lines + below_legend : 0;
  const double height = 160 + 270 * relative + legend_height;
  const double gap = 28 / height;
  const double top = 1 - (figure.title.empty() ? 14 : 38) / height;
  const double bottom = 76 / height;  // room for the abscissa
  const double unit = (top - bottom - gap * (count - 1) - legend_height / height) / relative;

  std::string body = data_blocks(figure);
  body +=
      "set multiplot\n"
      "set border 3 lc rgb '#555555'\nset tics out nomirror scale 0.6 tc rgb '#333333'\n"
      "set grid lc rgb '#e4e4e4' lw 1 dt solid\n"
      "set autoscale xfix\n";
  body += fmt::format("set lmargin at screen {}\nset rmargin at screen {}\n", left, right);
  if (cycles > 0) body += colour_scale(cycles, bottom, top);
  body += common_range(figure);
  if (!figure.title.empty())
    body += fmt::format("set label 1 {} at screen {},{:.4f} left noenhanced\n",
                        gnuplot_text(figure.title), left, 1 - 18 / height);
  double upper = top;
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    const Panel& panel = figure.panels[p];
    const double legend = upper - 2 / height;  // its upper edge
    if (legends[p] > 0) upper -= (row * legends[p] + below_legend) / height;
    const double lower = upper - unit * panel.height;
    body +=
        fmt::format("set tmargin at screen {:.4f}\nset bmargin at screen {:.4f}\n", upper, lower);
    body += fmt::format("set label 2 {} at screen 0.02,{:.4f} center rotate by 90 noenhanced\n",
                        gnuplot_text(ordinate_lines(panel.ordinate, height * (upper - lower))),
                        0.5 * (upper + lower));
    body += legends[p] > 0
                ? fmt::format(
                      "set key at screen {},{:.4f} right top horizontal Left reverse maxrows {} "
                      "samplen 2.5 spacing 1.1 noautotitle\n",
                      right, legend, legends[p])
                : std::string("unset key\n");
    body += log_commands(figure, panel);
    body += range_command(panel);
    const bool last = p + 1 == figure.panels.size();
    body += last ? fmt::format("set format x '%g'\nset xlabel {} noenhanced\n",
                               gnuplot_text(figure.abscissa))
                 : std::string("set format x ''\nunset xlabel\n");
    body += plot_command(panel, p) + "unset label 1\nunset colorbox\n";
    upper = lower - gap;
  }
  body += "unset multiplot\n";
  return run_gnuplot(body, stem, width, static_cast<int>(height));
}

}  // namespace verification
