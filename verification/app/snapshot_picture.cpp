#include "app/gnuplot.hpp"
#include "app/snapshot.hpp"
#include "app/text.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <sstream>

namespace verification {
namespace {

constexpr double millimetre = 1e3;  // mm per m

using Point = std::array<double, 2>;

struct Extent {
  Point low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  void add(double x, double y, double margin) {
    low = {std::min(low[0], x - margin), std::min(low[1], y - margin)};
    high = {std::max(high[0], x + margin), std::max(high[1], y + margin)};
  }
  [[nodiscard]] double width() const { return high[0] - low[0]; }
  [[nodiscard]] double height() const { return high[1] - low[1]; }
};

Extent extent(const Snapshot& snapshot) {
  Extent all;
  for (std::size_t p = 0; p < snapshot.size(); ++p)
    all.add(snapshot.x[p], snapshot.y[p], snapshot.radius[p]);
  return all;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

double mean_force(const Snapshot& snapshot) {
  double sum = 0;
  for (const SnapshotContact& contact : snapshot.contacts) sum += std::abs(contact.normal_force);
  return snapshot.contacts.empty() ? 0 : sum / static_cast<double>(snapshot.contacts.size());
}

// Moves every particle of a periodic cell to its image in the cell.
Snapshot in_cell(Snapshot snapshot) {
  if (!snapshot.boundary.empty()) return snapshot;
  const int d = snapshot.spheres() ? 3 : 2;
  Eigen::MatrixXd cell(d, d);
  for (int i = 0; i < d; ++i)
    for (int j = 0; j < d; ++j) cell(i, j) = snapshot.cell[static_cast<std::size_t>(d * i + j)];
  const Eigen::MatrixXd to_cell = cell.inverse();
  for (std::size_t p = 0; p < snapshot.size(); ++p) {
    Eigen::VectorXd x(d);
    x(0) = snapshot.x[p];
    x(1) = snapshot.y[p];
    if (d == 3) x(2) = snapshot.z[p];
    x -= cell * Eigen::VectorXd((to_cell * x).array().floor());
    snapshot.x[p] = x(0);
    snapshot.y[p] = x(1);
    if (d == 3) snapshot.z[p] = x(2);
  }
  return snapshot;
}

// Caption broken into lines of the picture's width.
std::string broken(const std::string& title, double pixels) {
  constexpr double letter = 10;  // pixels per letter
  const auto most = static_cast<std::size_t>(std::max(8.0, pixels / letter));
  std::string text;
  std::size_t in_line = 0;
  std::istringstream words(title);
  for (std::string word; words >> word;) {
    if (in_line > 0 && in_line + 1 + word.size() > most) {
      text += '\n';
      in_line = 0;
    } else if (in_line > 0) {
      text += ' ';
      ++in_line;
    }
    text += word;
    in_line += word.size();
  }
  return text;
}

// Spheres seen along y: discs in the plane of x and z, far ones first. Contacts above the mean
// force are kept, since the others would hide them.
Snapshot seen_from_front(const Snapshot& snapshot) {
  if (!snapshot.spheres()) return snapshot;
  std::vector<int> order(snapshot.size()), place(snapshot.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return snapshot.y[static_cast<std::size_t>(a)] > snapshot.y[static_cast<std::size_t>(b)];
  });
  Snapshot seen;
  for (const int p : order) {
    const auto from = static_cast<std::size_t>(p);
    place[from] = static_cast<int>(seen.size());
    seen.x.push_back(snapshot.x[from]);
    seen.y.push_back(snapshot.z[from]);
    seen.radius.push_back(snapshot.radius[from]);
  }
  const double mean = mean_force(snapshot);
  for (SnapshotContact contact : snapshot.contacts) {
    if (std::abs(contact.normal_force) < mean) continue;
    contact.i = place[static_cast<std::size_t>(contact.i)];
    contact.j = place[static_cast<std::size_t>(contact.j)];
    contact.branch = {contact.branch[0], contact.branch[2], 0};
    seen.contacts.push_back(contact);
  }
  return seen;
}

std::string discs(const Snapshot& snapshot, bool of_boundary) {
  std::vector<char> on_boundary(snapshot.size(), 0);
  for (const int p : snapshot.boundary) on_boundary[static_cast<std::size_t>(p)] = 1;
  std::string text;
  for (std::size_t p = 0; p < snapshot.size(); ++p)
    if ((on_boundary[p] != 0) == of_boundary)
      fmt::format_to(std::back_inserter(text), "{:.4g} {:.4g} {:.4g}\n", millimetre * snapshot.x[p],
                     millimetre * snapshot.y[p], millimetre * snapshot.radius[p]);
  return text;
}

// Rectangles along branches, as closed polygons.
template <class Choice>
std::string bars(const Snapshot& snapshot, double width_per_force, double widest, Choice&& choice) {
  std::string text;
  for (const SnapshotContact& contact : snapshot.contacts) {
    const double length = std::hypot(contact.branch[0], contact.branch[1]);
    const double width = std::min(std::abs(contact.normal_force) * width_per_force, widest);
    if (!choice(contact) || width <= 0 || length <= 0) continue;
    const auto i = static_cast<std::size_t>(contact.i);
    const Point from{snapshot.x[i], snapshot.y[i]};
    const Point to{from[0] + contact.branch[0], from[1] + contact.branch[1]};
    const Point across{-contact.branch[1] / length * 0.5 * width,
                       contact.branch[0] / length * 0.5 * width};
    for (const auto& [end, side] :
         {std::pair{&from, 1.0}, {&to, 1.0}, {&to, -1.0}, {&from, -1.0}, {&from, 1.0}})
      fmt::format_to(std::back_inserter(text), "{:.5g} {:.5g}\n",
                     millimetre * ((*end)[0] + side * across[0]),
                     millimetre * ((*end)[1] + side * across[1]));
    text += "\n";
  }
  return text;
}

std::string outline(const Snapshot& snapshot) {
  std::string text;
  for (std::size_t k = 0; k <= snapshot.boundary.size() && !snapshot.boundary.empty(); ++k) {
    const auto p = static_cast<std::size_t>(snapshot.boundary[k % snapshot.boundary.size()]);
    fmt::format_to(std::back_inserter(text), "{:.5g} {:.5g}\n", millimetre * snapshot.x[p],
                   millimetre * snapshot.y[p]);
  }
  return text;
}

struct Layer {
  const char* name;
  std::string data;
  std::string style;
};

std::vector<Layer> layers(const Snapshot& snapshot, double width_per_force) {
  const double widest = 1.6 * mean(snapshot.radius);
  const auto bar = [&](auto&& choice) { return bars(snapshot, width_per_force, widest, choice); };
  return {{"inner", discs(snapshot, false),
           "using 1:2:3 with circles fs solid border lc rgb '#8f8670' fc rgb '#f1ede2'"},
          {"boundary", discs(snapshot, true),
           "using 1:2:3 with circles fs solid border lc rgb '#9a907c' fc rgb '#d9cfb6'"},
          {"outline", outline(snapshot), "with lines lc rgb '#777777' lw 0.8 dt (4,3)"},
          {"frictional", bar([](const SnapshotContact& c) { return !c.bonded; }),
           "with filledcurves closed fs transparent solid 0.75 noborder fc rgb '#0072b2'"},
          {"bonded", bar([](const SnapshotContact& c) { return c.bonded && c.normal_force >= 0; }),
           "with filledcurves closed fs transparent solid 0.75 noborder fc rgb '#d1281a'"},
          {"tension", bar([](const SnapshotContact& c) { return c.bonded && c.normal_force < 0; }),
           "with filledcurves closed fs transparent solid 0.75 noborder fc rgb '#e69f00'"}};
}

long breaks(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

}  // namespace

bool draw_snapshots(const std::vector<SnapshotPanel>& all, double force, const std::string& title,
                    const std::filesystem::path& stem) {
  if (all.empty()) return true;
  std::vector<SnapshotPanel> panels;
  for (const SnapshotPanel& panel : all)
    panels.push_back({panel.title, seen_from_front(in_cell(panel.snapshot))});
  constexpr double pixels_wide = 860;
  constexpr double gap = 14, line = 22, foot = 8;  // pixels
  const bool spheres = all.front().snapshot.spheres();
  double unit = force;
  if (force == 0)
    for (const SnapshotPanel& panel : panels)
      unit = std::max(unit, (spheres ? 12 : 4) * mean_force(panel.snapshot));
  const double width_per_force = unit > 0 ? mean(panels.front().snapshot.radius) / unit : 0;

  std::vector<Extent> extents;
  double total = 0, highest = 0;
  for (const SnapshotPanel& panel : panels) {
    extents.push_back(extent(panel.snapshot));
    total += extents.back().width();
    highest = std::max(highest, extents.back().height());
  }
  const double count = static_cast<double>(panels.size());
  constexpr double tallest = 500;  // pixels
  const double scale = std::min((pixels_wide - gap * (count + 1)) / total, tallest / highest);
  const double wide = scale * total + gap * (count + 1);
  const std::string head = broken(title, wide - 2 * gap);
  const double captions = 40 + line * static_cast<double>(breaks(head));  // top margin
  double heading = captions + 16;
  for (std::size_t k = 0; k < panels.size(); ++k) {
    panels[k].title = broken(panels[k].title, scale * extents[k].width());
    heading =
        std::max(heading, captions + 16 + line * static_cast<double>(breaks(panels[k].title)));
  }
  const double high = scale * highest + heading + foot;

  std::string body = "set multiplot\nunset border\nunset tics\nunset key\n";
  body += fmt::format("set label 1 {} at screen {:.5f},{:.5f} left noenhanced\n",
                      gnuplot_text(head), gap / wide, 1 - 16 / high);
  double left = gap;
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const Extent& e = extents[k];
    const double right = left + scale * e.width();
    std::vector<std::string> items;
    for (const Layer& layer : layers(panels[k].snapshot, width_per_force)) {
      if (layer.data.empty()) continue;
      body += fmt::format("$s{}{} << EOD\n{}EOD\n", layer.name, k, layer.data);
      items.push_back(fmt::format("$s{}{} {}", layer.name, k, layer.style));
    }
    body += fmt::format(
        "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\n"
        "set bmargin at screen {:.5f}\nset tmargin at screen {:.5f}\n",
        left / wide, right / wide, foot / high, (foot + scale * e.height()) / high);
    body += fmt::format("set xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]\n",
                        millimetre * e.low[0], millimetre * e.high[0], millimetre * e.low[1],
                        millimetre * e.high[1]);
    body += fmt::format("set label 2 {} at screen {:.5f},{:.5f} left noenhanced\n",
                        gnuplot_text(panels[k].title), left / wide, 1 - captions / high);
    body += fmt::format("plot {}\nunset label 1\n", fmt::join(items, ", "));
    left = right + gap;
  }
  body += "unset multiplot\n";
  return run_gnuplot(body, stem, static_cast<int>(std::lround(wide)),
                     static_cast<int>(std::lround(high)));
}

}  // namespace verification
