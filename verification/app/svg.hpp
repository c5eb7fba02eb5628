// Pictures written as SVG by ourselves: circles stay circles, of which gnuplot would make polygons. Their
// PNG is made by rsvg-convert.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace verification {

// Lengths are pixels, from the upper left corner; attributes are those of SVG.
class Svg {
 public:
  // What is drawn until the end has the attributes of the group.
  void begin(std::string_view attributes);
  void end() { body_ += "</g>\n"; }
  void circle(double x, double y, double radius);
  void path(std::string_view commands, std::string_view attributes = {});
  // A line break in the text starts a line below.
  void text(double x, double y, std::string_view text, std::string_view attributes = {});
  // Adds an element of <defs>, e.g. a gradient, once.
  void define(std::string_view element) {
    if (definitions_.find(element) == std::string::npos) definitions_ += element;
  }

  // stem.svg and stem.png, or neither and false; as run_gnuplot.
  [[nodiscard]] bool write(const std::filesystem::path& stem, double width, double height) const;

 private:
  std::string definitions_, body_;
};

// "M1 2L3 4" of a polygon's corners, with "Z" where it is closed.
std::string polyline(const std::vector<std::array<double, 2>>& corners, bool closed);

constexpr double letter_width = 7.8;  // of the text of an Svg, in the mean [pixels]
constexpr double line_height = 18;

// A text in as many lines as a width [pixels] asks for.
std::string broken(const std::string& text, double width);

// One entry of a key: how wide it is, and how it is drawn with its middle at a height.
struct KeyEntry {
  double width;
  std::function<void(Svg&, double x, double y)> draw;
};

// Entries from left to right, in as many lines as the width asks for. Returns their height [pixels].
double draw_key(Svg& svg, const std::vector<KeyEntry>& entries, double left, double top,
                double width);

}  // namespace verification
