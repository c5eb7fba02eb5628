// Pictures: panels of curves above one another with a common abscissa, drawn by gnuplot.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace verification {

enum class Stroke { solid, dashed, thin, none };

struct Curve {
  std::string title;  // "" : not in the legend
  std::vector<double> x;
  std::vector<double> y;
  std::string colour = "#0072b2";
  Stroke stroke = Stroke::solid;
  int marker = 0;                     // gnuplot's point type at every point; 0: none
  std::vector<double> low{}, high{};  // of a band around it; empty: none
  std::vector<int> cycles{};          // of the points, told by colour instead; empty: none
};

struct Panel {
  std::string ordinate;  // with its unit
  std::vector<Curve> curves{};
  double height = 1;         // relative to the other panels
  bool logarithmic = false;  // ordinate
  double lowest = 0;         // lower end of a logarithmic ordinate; 0: of the data
};

struct Figure {
  std::string title;
  std::string abscissa;  // with its unit
  std::vector<Panel> panels;
  bool logarithmic = false;  // abscissa
  double room = 0.012;       // at the ends of a linear abscissa, of its length
};

// Colours that stay apart for colour-blind readers (Okabe and Ito).
namespace colour {
inline constexpr const char* black = "#222222";
inline constexpr const char* grey = "#999999";
inline constexpr const char* blue = "#0072b2";
inline constexpr const char* orange = "#d55e00";
inline constexpr const char* green = "#009e73";
inline constexpr const char* purple = "#cc79a7";
inline constexpr const char* sky = "#56b4e9";
inline constexpr const char* amber = "#e69f00";
}  // namespace colour

// Writes stem.svg and stem.png. Returns what run_gnuplot does, and fails as it does.
bool draw(const Figure& figure, const std::filesystem::path& stem);

}  // namespace verification
