#include "pack/picture.hpp"

#include "app/csv.hpp"
#include "app/figure.hpp"
#include "app/library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

namespace verification {
namespace {

constexpr double millimetre = 1e3;  // mm per m

struct Drawing {
  std::string discs;
  std::string bars;
  Eigen::Vector2d low;  // corner of the picture [m]
  Eigen::Vector2d high;

  void disc(const Eigen::Vector2d& centre, double radius) {
    const Eigen::Vector2d p = centre * millimetre;
    fmt::format_to(std::back_inserter(discs), "{:.5g} {:.5g} {:.5g}\n", p.x(), p.y(),
                   radius * millimetre);
  }
  // A rectangle from one centre to the other, as a closed polygon.
  void bar(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width) {
    const Eigen::Vector2d along = (to - from).normalized() * 0.5 * width;
    const Eigen::Vector2d across(-along.y(), along.x());
    const Eigen::Vector2d corner = from + across;
    for (const Eigen::Vector2d& p :
         {corner, Eigen::Vector2d(to + across), Eigen::Vector2d(to - across),
          Eigen::Vector2d(from - across), corner})
      fmt::format_to(std::back_inserter(bars), "{:.5g} {:.5g}\n", p.x() * millimetre,
                     p.y() * millimetre);
    bars += "\n";
  }
  [[nodiscard]] bool visible(const Eigen::Vector2d& p, double margin) const {
    return (p - low).minCoeff() > -margin && (high - p).minCoeff() > -margin;
  }
};

struct Discs {
  Eigen::Matrix2d cell;
  std::vector<Eigen::Vector2d> centre;
  std::vector<Eigen::Vector2i> wrap;  // cells by which the written position was shifted
  std::vector<double> radius;
  std::map<int, std::size_t> number;  // of an id
  bool periodic = true;
};

Discs read_discs(const std::string& prefix) {
  const CsvTable table = read_csv(prefix + "_particles.csv");
  const CsvTable cell = read_csv(prefix + "_cell.csv");
  Discs discs;
  discs.cell << cell["H00"][0], cell["H01"][0], cell["H10"][0], cell["H11"][0];
  discs.periodic = std::find(table.names.begin(), table.names.end(), "role") == table.names.end();
  discs.radius = table["r"];
  for (std::size_t p = 0; p < table.rows(); ++p) {
    Eigen::Vector2d centre(table["x"][p], table["y"][p]);
    Eigen::Vector2i wrap = Eigen::Vector2i::Zero();
    if (discs.periodic) {
      wrap = (discs.cell.inverse() * centre).array().floor().cast<int>();
      centre -= discs.cell * wrap.cast<double>();
    }
    discs.centre.push_back(centre);
    discs.wrap.push_back(wrap);
    discs.number[static_cast<int>(table["id"][p])] = p;
  }
  return discs;
}

// The lattice vectors of the images to draw.
std::vector<Eigen::Vector2d> images(const Discs& discs) {
  std::vector<Eigen::Vector2d> shifts;
  const int reach = discs.periodic ? 1 : 0;
  for (int a = -reach; a <= reach; ++a)
    for (int b = -reach; b <= reach; ++b) shifts.push_back(discs.cell * Eigen::Vector2d(a, b));
  return shifts;
}

Drawing make_drawing(const Discs& discs, const CsvTable& contacts) {
  Drawing drawing;
  const double largest = *std::max_element(discs.radius.begin(), discs.radius.end());
  drawing.low.setConstant(1e300);
  drawing.high.setConstant(-1e300);
  if (discs.periodic) {
    for (const Eigen::Vector2d& corner : {Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0),
                                          Eigen::Vector2d(0, 1), Eigen::Vector2d(1, 1)}) {
      drawing.low = drawing.low.cwiseMin(discs.cell * corner);
      drawing.high = drawing.high.cwiseMax(discs.cell * corner);
    }
  } else {
    for (std::size_t p = 0; p < discs.centre.size(); ++p) {
      drawing.low =
          drawing.low.cwiseMin(Eigen::Vector2d(discs.centre[p].array() - discs.radius[p]));
      drawing.high =
          drawing.high.cwiseMax(Eigen::Vector2d(discs.centre[p].array() + discs.radius[p]));
    }
  }
  const std::vector<Eigen::Vector2d> shifts = images(discs);
  for (std::size_t p = 0; p < discs.centre.size(); ++p)
    for (const Eigen::Vector2d& shift : shifts)
      if (drawing.visible(discs.centre[p] + shift, discs.radius[p]))
        drawing.disc(discs.centre[p] + shift, discs.radius[p]);

  const std::vector<double>& force = contacts["fn"];
  double mean = 0;
  for (const double f : force) mean += f / static_cast<double>(force.size());
  for (std::size_t c = 0; c < contacts.rows(); ++c) {
    const std::size_t i = discs.number.at(static_cast<int>(contacts["i"][c]));
    const std::size_t j = discs.number.at(static_cast<int>(contacts["j"][c]));
    // The written shift belongs to unwrapped positions.
    const Eigen::Vector2d shift(contacts["shift_x"][c], contacts["shift_y"][c]);
    const Eigen::Vector2d cells = shift + (discs.wrap[j] - discs.wrap[i]).cast<double>();
    const Eigen::Vector2d from = discs.centre[i];
    const Eigen::Vector2d to = discs.centre[j] + discs.cell * cells;
    const double width = 0.14 * largest * std::min(force[c] / mean, 6.0);
    for (const Eigen::Vector2d& image : shifts)
      if (drawing.visible(from + image, largest) || drawing.visible(to + image, largest))
        drawing.bar(from + image, to + image, width);
  }
  return drawing;
}

}  // namespace

void draw_packing(const std::string& prefix, const std::filesystem::path& stem,
                  const std::string& title) {
  const Discs discs = read_discs(prefix);
  const CsvTable contacts = read_csv(prefix + "_contacts.csv");
  const Drawing drawing = make_drawing(discs, contacts);
  const Eigen::Vector2d low = drawing.low * millimetre;
  const Eigen::Vector2d high = drawing.high * millimetre;
  std::string body =
      fmt::format("$discs << EOD\n{}EOD\n$bars << EOD\n{}EOD\n", drawing.discs, drawing.bars);
  body +=
      fmt::format("set xrange [{}:{}]\nset yrange [{}:{}]\n", low.x(), high.x(), low.y(), high.y());
  body += fmt::format("set title '{}' noenhanced\n", title);
  body +=
      "set size ratio -1\nset border 15 lc rgb '#555555'\nset tics out nomirror scale 0.6\n"
      "set xlabel 'x [mm]'\nset ylabel 'y [mm]'\nunset key\n"
      "plot $discs using 1:2:3 with circles fs solid border lc rgb '#b5ac9a' fc rgb '#ece8df', "
      "$bars with filledcurves closed fc rgb '#0072b2'\n";
  const double aspect = (high.y() - low.y()) / (high.x() - low.x());
  constexpr int width = 800;
  run_gnuplot(body, stem, width, static_cast<int>(width * aspect) + 30);
}

}  // namespace verification
