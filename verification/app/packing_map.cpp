#include "app/packing_map.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

namespace verification {
namespace {

constexpr double millimetre = 1e3;  // mm per m

// The cell's vectors as columns.
Eigen::MatrixXd cell_of(const Snapshot& snapshot) {
  const int d = snapshot.spheres() ? 3 : 2;
  Eigen::MatrixXd cell(d, d);
  for (int i = 0; i < d; ++i)
    for (int j = 0; j < d; ++j) cell(i, j) = snapshot.cell[static_cast<std::size_t>(d * i + j)];
  return cell;
}

// A particle's centre at its image within a periodic cell.
Eigen::VectorXd centre_of(const Snapshot& snapshot, std::size_t p, const Eigen::MatrixXd& cell) {
  Eigen::VectorXd x(cell.rows());
  x(0) = snapshot.x[p];
  x(1) = snapshot.y[p];
  if (snapshot.spheres()) x(2) = snapshot.z[p];
  if (snapshot.boundary.empty()) x -= cell * Eigen::VectorXd((cell.inverse() * x).array().floor());
  return x;
}

// The largest of 1, 2, 5, 10 ... that is not above a length.
double round_length(double length) {
  const double ten = std::pow(10, std::floor(std::log10(length)));
  return ten * (length >= 5 * ten ? 5 : length >= 2 * ten ? 2 : 1);
}

KeyEntry entry(double sample, const std::string& text,
               const std::function<void(Svg&, double, double)>& draw) {
  return {sample + 8 + letter_width * static_cast<double>(text.size()),
          [=](Svg& svg, double x, double y) {
            draw(svg, x, y);
            svg.text(x + sample + 8, y + 5, text, "fill='#333333'");
          }};
}

constexpr const char* frictional_colour = "#0072b2";
constexpr const char* bonded_colour = "#d1281a";
constexpr const char* tension_colour = "#e69f00";

}  // namespace

PackingMap::PackingMap(const Snapshot& snapshot) : spheres_(snapshot.spheres()) {
  constexpr double far = std::numeric_limits<double>::infinity();
  low_ = {far, far};
  high_ = {-far, -far};
  for (const SnapshotContact& contact : snapshot.contacts)
    mean_force_ += std::abs(contact.normal_force) / static_cast<double>(snapshot.contacts.size());
  spheres_ ? look_at_spheres(snapshot) : look_at_discs(snapshot);
}

void PackingMap::include(const Point& point, double margin) {
  for (std::size_t k = 0; k < 2; ++k) {
    low_[k] = std::min(low_[k], point[k] - margin);
    high_[k] = std::max(high_[k], point[k] + margin);
  }
}

bool PackingMap::visible(const Point& point, double margin) const {
  return point[0] > low_[0] - margin && point[0] < high_[0] + margin &&
         point[1] > low_[1] - margin && point[1] < high_[1] + margin;
}

void PackingMap::look_at_discs(const Snapshot& snapshot) {
  const Eigen::MatrixXd cell = cell_of(snapshot);
  cut_ = snapshot.boundary.empty();
  std::vector<Point> centres;
  for (std::size_t p = 0; p < snapshot.size(); ++p) {
    const Eigen::VectorXd x = centre_of(snapshot, p, cell);
    centres.push_back({x(0), x(1)});
    if (!cut_) include(centres.back(), 1.03 * snapshot.radius[p]);
  }
  std::vector<int> kind(snapshot.size(), 0);
  for (const std::size_t p : snapshot.boundary) {
    kind[p] = 1;
    outline_.push_back(centres[p]);
  }
  if (cut_)
    for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      const Eigen::VectorXd corner = cell.col(0) * a + cell.col(1) * b;
      outline_.push_back({corner(0), corner(1)});
      include(outline_.back(), 0);
    }
  const double largest = *std::max_element(snapshot.radius.begin(), snapshot.radius.end());
  const int reach = cut_ ? 1 : 0;
  for (int a = -reach; a <= reach; ++a)
    for (int b = -reach; b <= reach; ++b) {
      const Eigen::VectorXd image = cell.col(0) * a + cell.col(1) * b;
      const auto at = [&](int p) -> Point {
        const Point& centre = centres[static_cast<std::size_t>(p)];
        return {centre[0] + image(0), centre[1] + image(1)};
      };
      for (std::size_t p = 0; p < snapshot.size(); ++p)
        if (visible(at(static_cast<int>(p)), snapshot.radius[p]))
          particles_.push_back({at(static_cast<int>(p)), snapshot.radius[p], kind[p]});
      for (const SnapshotContact& c : snapshot.contacts) {
        const Point from = at(c.i), to{from[0] + c.branch[0], from[1] + c.branch[1]};
        if (visible(from, largest) || visible(to, largest))
          bars_.push_back({from, to, c.normal_force, c.bonded, depths - 1});
      }
    }
}

void PackingMap::look_at_spheres(const Snapshot& snapshot) {
  const Eigen::MatrixXd cell = cell_of(snapshot);
  std::vector<Eigen::VectorXd> centres;
  for (std::size_t p = 0; p < snapshot.size(); ++p) centres.push_back(centre_of(snapshot, p, cell));
  std::vector<std::size_t> order(snapshot.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return centres[a](1) > centres[b](1); });
  const double near = centres[order.back()](1);
  const double range = std::max(centres[order.front()](1) - near, 1e-300);
  const auto depth = [&](double y) {
    return std::clamp(static_cast<int>(depths * (1 - (y - near) / range)), 0, depths - 1);
  };
  for (const std::size_t p : order) {
    const Point seen{centres[p](0), centres[p](2)};
    include(seen, 1.03 * snapshot.radius[p]);
    particles_.push_back({seen, snapshot.radius[p], depth(centres[p](1))});
  }
  for (const SnapshotContact& c : snapshot.contacts) {
    if (std::abs(c.normal_force) < mean_force_) continue;
    // Across a side of the cell a bar is drawn to the middle from both ends.
    const Eigen::VectorXd &from = centres[static_cast<std::size_t>(c.i)],
                          &to = centres[static_cast<std::size_t>(c.j)];
    const Eigen::Vector3d branch(c.branch[0], c.branch[1], c.branch[2]);
    const bool within = (to - from - branch).norm() < 1e-6 * branch.norm();
    const auto add = [&](const Eigen::Vector3d& start, const Eigen::Vector3d& end) {
      bars_.push_back({{start(0), start(2)},
                       {end(0), end(2)},
                       c.normal_force,
                       c.bonded,
                       depth(0.5 * (start(1) + end(1)))});
    };
    add(from, from + (within ? 1 : 0.5) * branch);
    if (!within) add(to, to - 0.5 * branch);
  }
}

double PackingMap::mean_radius() const {
  double sum = 0;
  for (const Particle& particle : particles_) sum += particle.radius;
  return sum / static_cast<double>(particles_.size());
}

void PackingMap::draw_particles(Svg& svg, double left, double top, const MapScale& scale) const {
  const std::array<const char*, 2> fills{"fill='#f1ede2' stroke='#8f8670' stroke-width='0.8'",
                                         "fill='#d9cfb6' stroke='#8f8670' stroke-width='0.8'"};
  if (spheres_)
    for (int depth = 0; depth < depths; ++depth) {
      const int shade = 14 * (depths - 1 - depth);  // far ones are paler
      svg.define(fmt::format(
          "<radialGradient id='sphere{}' cx='0.38' cy='0.32' r='0.75'><stop offset='0' "
          "stop-color='#ffffff'/><stop offset='1' stop-color='rgb({},{},{})'/></radialGradient>",
          depth, 160 + shade, 152 + shade, 132 + shade));
    }
  const int kinds = spheres_ ? depths : 2;
  for (int kind = 0; kind < kinds; ++kind) {
    svg.begin(spheres_
                  ? fmt::format("fill='url(#sphere{})' stroke='#777060' stroke-width='0.4'", kind)
                  : std::string(fills[static_cast<std::size_t>(kind)]));
    for (const Particle& p : particles_)
      if (p.kind == kind)
        svg.circle(left + scale.length * (p.centre[0] - low_[0]),
                   top + scale.length * (high_[1] - p.centre[1]), scale.length * p.radius);
    svg.end();
  }
}

void PackingMap::draw_bars(Svg& svg, double left, double top, const MapScale& scale) const {
  constexpr double step = 0.5;                                     // of widths [pixels]
  std::map<std::tuple<int, std::string, int>, std::string> paths;  // depth, colour, width
  for (const Bar& bar : bars_) {
    const double wide = std::min(std::abs(bar.force) * scale.force, scale.widest);
    const int width = static_cast<int>(std::lround(wide / step));
    if (width == 0) continue;
    const char* colour = !bar.bonded      ? frictional_colour
                         : bar.force >= 0 ? bonded_colour
                                          : tension_colour;
    fmt::format_to(std::back_inserter(paths[{bar.depth, colour, width}]),
                   "M{:.4g} {:.4g}l{:.3g} {:.3g}", left + scale.length * (bar.from[0] - low_[0]),
                   top + scale.length * (high_[1] - bar.from[1]),
                   scale.length * (bar.to[0] - bar.from[0]),
                   scale.length * (bar.from[1] - bar.to[1]));
  }
  for (const auto& [how, commands] : paths) {
    const auto& [depth, colour, width] = how;
    svg.path(commands, fmt::format("stroke='{}' stroke-width='{:.3g}' stroke-opacity='{:.2g}'",
                                   colour, step * width, 0.8 - 0.12 * (depths - 1 - depth)));
  }
}

void PackingMap::draw(Svg& svg, double left, double top, const MapScale& scale) const {
  std::vector<Point> outline;
  for (const Point& corner : outline_)
    outline.push_back(
        {left + scale.length * (corner[0] - low_[0]), top + scale.length * (high_[1] - corner[1])});
  const std::string line = polyline(outline, true);
  const std::string name = fmt::format("cell{:.0f}", left);
  if (cut_) {
    svg.define(fmt::format("<clipPath id='{}'><path d='{}'/></clipPath>", name, line));
    svg.begin(fmt::format("clip-path='url(#{})'", name));
  }
  draw_particles(svg, left, top, scale);
  draw_bars(svg, left, top, scale);
  if (cut_) svg.end();
  if (!outline_.empty())
    svg.path(line, fmt::format("fill='none' stroke='#555555' stroke-width='1' {}",
                               cut_ ? "" : "stroke-dasharray='4 3'"));
}

std::vector<KeyEntry> PackingMap::key(const MapScale& scale) const {
  const auto bar = [](const char* colour, double length, double width) {
    return [=](Svg& svg, double x, double y) {
      svg.path(fmt::format("M{:.4g} {:.4g}h{:.4g}", x, y, length),
               fmt::format("stroke='{}' stroke-width='{:.3g}'", colour, width));
    };
  };
  const double length = round_length(0.3 * width());
  const double pixels = scale.length * length;
  std::vector<KeyEntry> entries{
      entry(pixels, fmt::format("{:g} mm", millimetre * length),
            [pixels](Svg& svg, double x, double y) {
              svg.path(fmt::format("M{0:.4g} {1:.4g}v8m0 -4h{2:.4g}m0 -4v8", x, y - 4, pixels),
                       "stroke='#333333' fill='none'");
            }),
      entry(0, "", [this](Svg& svg, double x, double y) {
        svg.path(
            fmt::format("M{:.4g} {:.4g}v-14l-3 5m3 -5l3 5m-3 9h14l-5 -3m5 3l-5 3", x + 3, y + 7),
            "stroke='#333333' fill='none'");
        svg.text(x + 20, y + 11, "x", "fill='#333333'");
        svg.text(x + 7, y - 2, spheres_ ? "z" : "y", "fill='#333333'");
      })};
  entries.back().width = 28;
  const double width = std::min(mean_force_ * scale.force, scale.widest);
  if (width > 0)
    entries.push_back(entry(26,
                            fmt::format("normal force of {:.3g} N{}", mean_force_,
                                        spheres_ ? ", the mean, and above" : ", the mean"),
                            bar(frictional_colour, 26, std::max(width, 0.5))));
  const auto any = [this](bool tension) {
    return std::any_of(bars_.begin(), bars_.end(),
                       [tension](const Bar& b) { return b.bonded && (b.force < 0) == tension; });
  };
  if (any(false)) entries.push_back(entry(26, "bonded", bar(bonded_colour, 26, 4)));
  if (any(true)) entries.push_back(entry(26, "bonded, in tension", bar(tension_colour, 26, 4)));
  return entries;
}

}  // namespace verification
