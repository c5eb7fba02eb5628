#include "pack/picture.hpp"

#include "app/gnuplot.hpp"
#include "app/text.hpp"
#include "pack/rose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace verification {
namespace {

constexpr double millimetre = 1e3;  // mm per m

// Gnuplot data blocks in mm.
struct Drawing {
  std::string inner, boundary;  // discs
  std::string bars;
  std::string outline;  // outline of the frame or cell
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300);
  Eigen::Vector2d high = Eigen::Vector2d::Constant(-1e300);

  static void disc(std::string& text, const Eigen::Vector2d& centre, double radius) {
    const Eigen::Vector2d p = centre * millimetre;
    fmt::format_to(std::back_inserter(text), "{:.5g} {:.5g} {:.5g}\n", p.x(), p.y(),
                   radius * millimetre);
  }
  static void corner(std::string& text, const Eigen::Vector2d& place) {
    fmt::format_to(std::back_inserter(text), "{:.5g} {:.5g}\n", place.x() * millimetre,
                   place.y() * millimetre);
  }
  // A rectangle between two centres, as a closed polygon.
  void bar(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width) {
    const Eigen::Vector2d along = (to - from).normalized() * 0.5 * width;
    const Eigen::Vector2d across(-along.y(), along.x());
    for (const Eigen::Vector2d& p : {Eigen::Vector2d(from + across), Eigen::Vector2d(to + across),
                                     Eigen::Vector2d(to - across), Eigen::Vector2d(from - across),
                                     Eigen::Vector2d(from + across)})
      corner(bars, p);
    bars += "\n";
  }
  void include(const Eigen::Vector2d& place, double margin) {
    low = low.cwiseMin(Eigen::Vector2d(place.array() - margin));
    high = high.cwiseMax(Eigen::Vector2d(place.array() + margin));
  }
  [[nodiscard]] bool visible(const Eigen::Vector2d& p, double margin) const {
    return (p - low).minCoeff() > -margin && (high - p).minCoeff() > -margin;
  }
};

void draw_outline(const WrittenPacking& packing, Drawing& drawing) {
  std::vector<Eigen::Vector2d> places;
  if (packing.periodic()) {
    for (const Eigen::Vector2d& corner : {Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0),
                                          Eigen::Vector2d(1, 1), Eigen::Vector2d(0, 1)})
      places.push_back(packing.cell * corner);
  } else {
    for (const std::size_t p : packing.boundary) places.push_back(packing.centre[p]);
  }
  places.push_back(places.front());
  for (const Eigen::Vector2d& place : places) {
    Drawing::corner(drawing.outline, place);
    if (packing.periodic()) drawing.include(place, 0);
  }
}

Drawing make_drawing(const WrittenPacking& packing) {
  Drawing drawing;
  draw_outline(packing, drawing);
  if (!packing.periodic())
    for (std::size_t p = 0; p < packing.centre.size(); ++p)
      drawing.include(packing.centre[p], 1.02 * packing.radius[p]);
  std::vector<Eigen::Vector2d> images;
  const int reach = packing.periodic() ? 1 : 0;
  for (int a = -reach; a <= reach; ++a)
    for (int b = -reach; b <= reach; ++b) images.push_back(packing.cell * Eigen::Vector2d(a, b));
  std::vector<char> on_boundary(packing.centre.size(), 0);
  for (const std::size_t p : packing.boundary) on_boundary[p] = 1;
  for (std::size_t p = 0; p < packing.centre.size(); ++p)
    for (const Eigen::Vector2d& image : images)
      if (drawing.visible(packing.centre[p] + image, packing.radius[p]))
        Drawing::disc(on_boundary[p] != 0 ? drawing.boundary : drawing.inner,
                      packing.centre[p] + image, packing.radius[p]);

  const double largest = *std::max_element(packing.radius.begin(), packing.radius.end());
  double mean = 0;
  for (const WrittenContact& contact : packing.contacts)
    mean += contact.normal_force / static_cast<double>(packing.contacts.size());
  for (const WrittenContact& contact : packing.contacts) {
    const Eigen::Vector2d from = packing.centre[contact.i];
    const Eigen::Vector2d to = from + packing.branch(contact);
    const double width = 0.14 * largest * std::min(contact.normal_force / mean, 6.0);
    for (const Eigen::Vector2d& image : images)
      if (drawing.visible(from + image, largest) || drawing.visible(to + image, largest))
        drawing.bar(from + image, to + image, width);
  }
  return drawing;
}

// A data block, which gnuplot does not accept empty.
std::string block(const char* name, const std::string& lines) {
  return fmt::format("${} << EOD\n{}EOD\n", name, lines.empty() ? "NaN NaN NaN\n" : lines);
}

}  // namespace

bool draw_packing(const WrittenPacking& packing, const std::filesystem::path& stem,
                  const std::string& title) {
  constexpr int size = 760;  // side of the picture [points]
  constexpr int rose_size = 400;
  constexpr int head = 46;
  const Drawing drawing = make_drawing(packing);
  const Eigen::Vector2d low = drawing.low * millimetre;
  const Eigen::Vector2d high = drawing.high * millimetre;
  const Rose rose = contact_rose(packing);
  const double aspect = (high.y() - low.y()) / (high.x() - low.x());
  const int height = std::max(static_cast<int>(size * aspect), rose_size + 60) + head;
  const double left = static_cast<double>(size) / (size + rose_size);
  const double upper = 1 - static_cast<double>(head) / height;
  std::string body = block("inner", drawing.inner) + block("boundary", drawing.boundary) +
                     block("bars", drawing.bars) + block("outline", drawing.outline);
  body += fmt::format(
      "set multiplot\nset label 1 {} at screen 0.02,{:.4f} left noenhanced\n"
      "set origin 0,0\nset size {:.4f},{:.4f}\nset size ratio -1\n"
      "set xrange [{}:{}]\nset yrange [{}:{}]\n"
      "set border 15 lc rgb '#aaaaaa'\nset tics out nomirror scale 0.6 tc rgb '#333333'\n"
      "set xlabel 'x [mm]'\nset ylabel 'y [mm]'\nunset key\n",
      gnuplot_text(title), 1 - 0.5 * head / height, left, upper, low.x(), high.x(), low.y(),
      high.y());
  body +=
      "plot $inner using 1:2:3 with circles fs solid border lc rgb '#8f8670' fc rgb '#f1ede2', "
      "$boundary using 1:2:3 with circles fs solid border lc rgb '#b58a4a' fc rgb '#f3d19c', "
      "$outline using 1:2 with lines lc rgb '#d55e00' lw 1.5, "
      "$bars with filledcurves closed fs transparent solid 0.75 noborder fc rgb '#0072b2'\n";
  body += fmt::format(
      "unset label 1\nset label 2 'contact normals per angle, over the mean' at screen {0:.4f},"
      "{1:.4f} center noenhanced\nset label 3 'A = {2:.3f}, major at {3:.0f}°' at screen {0:.4f},"
      "{4:.4f} center noenhanced\nset origin {5:.4f},{6:.4f}\nset size {7:.4f},{8:.4f}\n",
      0.5 * (1 + left), 0.5 * upper + 0.5 * rose_size / height + 0.02, rose.anisotropy,
      rose.direction * 180 / M_PI, 0.5 * upper - 0.5 * rose_size / height - 0.005, left,
      0.5 * upper - 0.5 * rose_size / height, 1 - left, static_cast<double>(rose_size) / height);
  body += plot_rose(rose) + "unset multiplot\n";
  return run_gnuplot(body, stem, size + rose_size, height);
}

}  // namespace verification
