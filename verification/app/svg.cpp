#include "app/svg.hpp"

#include "app/atomic_file.hpp"
#include "app/filter.hpp"
#include "app/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <sstream>

namespace verification {

void Svg::begin(std::string_view attributes) {
  fmt::format_to(std::back_inserter(body_), "<g {}>\n", attributes);
}

void Svg::circle(double x, double y, double radius) {
  fmt::format_to(std::back_inserter(body_), "<circle cx='{:.4g}' cy='{:.4g}' r='{:.3g}'/>\n", x, y,
                 radius);
}

void Svg::path(std::string_view commands, std::string_view attributes) {
  fmt::format_to(std::back_inserter(body_), "<path d='{}' {}/>\n", commands, attributes);
}

void Svg::text(double x, double y, std::string_view text, std::string_view attributes) {
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line); y += line_height)
    fmt::format_to(std::back_inserter(body_), "<text x='{:.4g}' y='{:.4g}' {}>{}</text>\n", x, y,
                   attributes, xml_text(line));
}

bool Svg::write(const std::filesystem::path& stem, double width, double height) const {
  const std::string text = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:.0f} {1:.0f}' width='{0:.0f}' "
      "height='{1:.0f}' font-family='DejaVu Sans, sans-serif' font-size='14'>\n<defs>{2}</defs>\n"
      "<rect width='100%' height='100%' fill='#ffffff'/>\n{3}</svg>\n",
      std::ceil(width), std::ceil(height), definitions_, body_);
  const std::optional<std::string> png = filter({"rsvg-convert"}, "librsvg2-bin", text, stem);
  if (!png) return false;
  write_file(stem.string() + ".svg", text);
  write_file(stem.string() + ".png", *png);
  return true;
}

std::string polyline(const std::vector<std::array<double, 2>>& corners, bool closed) {
  std::string commands;
  for (const auto& [x, y] : corners)
    fmt::format_to(std::back_inserter(commands), "{}{:.4g} {:.4g}", commands.empty() ? 'M' : 'L', x,
                   y);
  return commands + (closed ? "Z" : "");
}

std::string broken(const std::string& text, double width) {
  const auto most = static_cast<std::size_t>(std::max(8.0, width / letter_width));
  std::string result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!result.empty()) result += '\n';
    std::size_t in_line = 0;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      if (in_line > 0) {
        const bool fits = in_line + 1 + word.size() <= most;
        result += fits ? ' ' : '\n';
        in_line = fits ? in_line + 1 : 0;
      }
      result += word;
      in_line += word.size();
    }
  }
  return result;
}

double draw_key(Svg& svg, const std::vector<KeyEntry>& entries, double left, double top,
                double width) {
  constexpr double gap = 24, line = 24;
  double x = left, y = top + 0.5 * line;
  for (const KeyEntry& entry : entries) {
    if (x > left && x + entry.width > left + width) {
      x = left;
      y += line;
    }
    entry.draw(svg, x, y);
    x += entry.width + gap;
  }
  return y + 0.5 * line - top;
}

}  // namespace verification
