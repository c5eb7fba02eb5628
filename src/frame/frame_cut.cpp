#include "frame/frame.hpp"

#include "base/error.hpp"
#include "frame/frame_chain.hpp"
#include "frame/frame_geometry.hpp"
#include "packing/geometry.hpp"
#include "packing/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

namespace grainlaw::core {

namespace {

// Limit of trial corners; more gain nothing in a large packing.
constexpr std::size_t most_origins = 512;

struct Candidate {
  double cost = 0;
  std::array<Chain, 2> chain;  // lower side, left side
};

// The periodic packing, positions wrapped into the cell.
struct Wrapped {
  std::size_t n = 0;
  std::array<double, 4> h{};
  std::vector<double> position;
  std::vector<std::array<int, 2>> cells;  // cell of each particle before wrapping
  std::vector<InitialContact> contacts;   // shifts between wrapped positions
  std::vector<NeighbourPair<2>> touching;
};

Wrapped wrap(const Packing& packing) {
  Wrapped out;
  out.n = packing.size();
  std::copy_n(packing.cell.begin(), 4, out.h.begin());
  out.position = packing.position;
  const auto& h = out.h;
  const double area = determinant<2>(h);
  for (std::size_t p = 0; p < out.n; ++p) {
    double& x = out.position[p];
    double& y = out.position[out.n + p];
    const double s0 = std::floor((h[3] * x - h[1] * y) / area);
    const double s1 = std::floor((h[0] * y - h[2] * x) / area);
    x -= h[0] * s0 + h[1] * s1;
    y -= h[2] * s0 + h[3] * s1;
    out.cells.push_back({static_cast<int>(s0), static_cast<int>(s1)});
  }
  out.contacts = packing.contacts;
  for (InitialContact& c : out.contacts)
    for (std::size_t k = 0; k < 2; ++k)
      c.shift[k] +=
          out.cells[static_cast<std::size_t>(c.j)][k] - out.cells[static_cast<std::size_t>(c.i)][k];
  NeighbourSearch<2>().find(out.n, out.position.data(), packing.radius.data(), h.data(), 0,
                            out.touching);
  return out;
}

// Both chains of every origin, cheapest first.
std::vector<Candidate> find_candidates(ChainGraph& graph, std::size_t n) {
  std::vector<Candidate> candidates;
  std::vector<char> blocked(n, 0);
  const std::size_t stride = (n + most_origins - 1) / most_origins;
  for (std::size_t origin = 0; origin < n; origin += stride) {
    const int o = static_cast<int>(origin);
    std::fill(blocked.begin(), blocked.end(), 0);
    auto lower = graph.shortest(o, 0, blocked);
    if (!lower) continue;
    for (const Site& site : lower->sites) blocked[static_cast<std::size_t>(site.particle)] = 1;
    auto left = graph.shortest(o, 1, blocked);
    if (!left) continue;
    candidates.push_back({lower->cost + left->cost, {*std::move(lower), *std::move(left)}});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  return candidates;
}

// Layout of a frame: site of each particle's first copy, and extent of its copies.
struct Layout {
  std::vector<std::array<int, 2>> first, extent;
  std::vector<Site> boundary;  // anticlockwise from O

  [[nodiscard]] int copies(int i, int j, int shift_0, int shift_1) const {
    const auto a = static_cast<std::size_t>(i);
    const auto b = static_cast<std::size_t>(j);
    return copies_along(extent[a][0], extent[b][0], shift_0 + first[a][0] - first[b][0]) *
           copies_along(extent[a][1], extent[b][1], shift_1 + first[a][1] - first[b][1]);
  }
};

Site shifted(Site site, int direction) {
  ++site.cell[static_cast<std::size_t>(direction)];
  return site;
}

// Layout of a candidate; nothing when it does not close without leaks.
std::optional<Layout> lay_out(const Candidate& candidate, const ChainGraph& graph,
                              const Wrapped& packing) {
  const auto& lower = candidate.chain[0].sites;
  const auto& left = candidate.chain[1].sites;
  Layout layout{std::vector<std::array<int, 2>>(packing.n), {}, {}};
  layout.extent.assign(packing.n, {-1, -1});
  for (std::size_t side = 0; side < 2; ++side) {
    const auto& chain = candidate.chain[side].sites;
    for (std::size_t k = 1; k + 1 < chain.size(); ++k) {
      const auto p = static_cast<std::size_t>(chain[k].particle);
      if (layout.extent[p][0] >= 0) return {};  // twice in the chain
      layout.first[p] = chain[k].cell;
      layout.extent[p] = {side == 0 ? 0 : 1, side == 0 ? 1 : 0};
    }
  }
  const auto origin = static_cast<std::size_t>(lower.front().particle);
  layout.first[origin] = {0, 0};
  layout.extent[origin] = {1, 1};

  auto& boundary = layout.boundary;
  boundary.assign(lower.begin(), lower.end() - 1);
  for (std::size_t k = 0; k + 1 < left.size(); ++k) boundary.push_back(shifted(left[k], 0));
  for (std::size_t k = lower.size() - 1; k > 0; --k) boundary.push_back(shifted(lower[k], 1));
  for (std::size_t k = left.size() - 1; k > 0; --k) boundary.push_back(left[k]);
  std::vector<Point> polygon;
  for (const Site& site : boundary) polygon.push_back(graph.position_of(site));
  if (!is_simple(polygon) || !(signed_area(polygon) > 0)) return {};

  // Every other particle needs exactly one image inside.
  for (std::size_t p = 0; p < packing.n; ++p) {
    if (layout.extent[p][0] >= 0) continue;
    layout.extent[p] = {0, 0};
    int inside = 0;
    for (int c0 = -2; c0 <= 2; ++c0)
      for (int c1 = -2; c1 <= 2; ++c1) {
        if (!is_inside(polygon, graph.position_of({static_cast<int>(p), {c0, c1}}))) continue;
        layout.first[p] = {c0, c1};
        ++inside;
      }
    if (inside != 1) return {};
  }
  const auto fits = [&](const auto& pair) {
    return layout.copies(pair.i, pair.j, pair.shift[0], pair.shift[1]) > 0;
  };
  if (!std::ranges::all_of(packing.touching, fits) || !std::ranges::all_of(packing.contacts, fits))
    return {};
  return layout;
}

Packing assemble(const Packing& periodic, const Wrapped& wrapped, const ChainGraph& graph,
                 const Layout& layout) {
  // Indices of the copies of each particle at 0..extent: number[p][o0 + 2 o1], first copies first.
  std::vector<std::array<int, 4>> number(wrapped.n, {-1, -1, -1, -1});
  std::vector<Site> sites;
  const auto add = [&](std::size_t p, int o0, int o1) {
    number[p][static_cast<std::size_t>(o0 + 2 * o1)] = static_cast<int>(sites.size());
    sites.push_back({static_cast<int>(p), {layout.first[p][0] + o0, layout.first[p][1] + o1}});
  };
  for (std::size_t p = 0; p < wrapped.n; ++p) add(p, 0, 0);
  for (std::size_t p = 0; p < wrapped.n; ++p)
    for (const auto& [o0, o1] : {std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)})
      if (o0 <= layout.extent[p][0] && o1 <= layout.extent[p][1]) add(p, o0, o1);
  const auto particle_at = [&](const Site& site) {
    const auto p = static_cast<std::size_t>(site.particle);
    return number[p][static_cast<std::size_t>(site.cell[0] - layout.first[p][0] +
                                              2 * (site.cell[1] - layout.first[p][1]))];
  };

  Packing packing;
  packing.thickness = periodic.thickness;
  packing.density = periodic.density;
  packing.cell = periodic.cell;
  packing.names_bonds = periodic.names_bonds;
  packing.position.resize(2 * sites.size());
  for (std::size_t q = 0; q < sites.size(); ++q) {
    const Point x = graph.position_of(sites[q]);
    packing.position[q] = x[0];
    packing.position[sites.size() + q] = x[1];
    packing.radius.push_back(periodic.radius[static_cast<std::size_t>(sites[q].particle)]);
  }

  for (const InitialContact& c : wrapped.contacts) {
    const auto a = static_cast<std::size_t>(c.i);
    const auto b = static_cast<std::size_t>(c.j);
    for (int o0 = 0; o0 <= layout.extent[a][0]; ++o0)
      for (int o1 = 0; o1 <= layout.extent[a][1]; ++o1) {
        const int t0 = o0 + c.shift[0] + layout.first[a][0] - layout.first[b][0];
        const int t1 = o1 + c.shift[1] + layout.first[a][1] - layout.first[b][1];
        if (t0 < 0 || t0 > layout.extent[b][0] || t1 < 0 || t1 > layout.extent[b][1]) continue;
        InitialContact copy = c;
        copy.shift = {};
        copy.i = number[a][static_cast<std::size_t>(o0 + 2 * o1)];
        copy.j = number[b][static_cast<std::size_t>(t0 + 2 * t1)];
        if (copy.i > copy.j) {
          std::swap(copy.i, copy.j);
          for (double& component : copy.tangential_force) component = -component;
          copy.moment[0] = -copy.moment[0];
        }
        packing.contacts.push_back(copy);
      }
  }
  std::sort(packing.contacts.begin(), packing.contacts.end(),
            [](const InitialContact& a, const InitialContact& b) {
              return std::tie(a.i, a.j) < std::tie(b.i, b.j);
            });

  Frame frame;
  for (const Site& site : layout.boundary) frame.boundary.push_back(particle_at(site));
  const int o = layout.boundary.front().particle;
  frame.corner = {particle_at({o, {0, 0}}), particle_at({o, {1, 0}}), particle_at({o, {1, 1}}),
                  particle_at({o, {0, 1}})};
  packing.frame = std::move(frame);
  complete_frame(packing);
  return packing;
}

}  // namespace

Packing cut_frame(const Packing& periodic, double largest_gap) {
  if (periodic.dimension != 2 || periodic.frame)
    throw Error(GRAINLAW_BAD_PACKING, "a frame is cut from a periodic 2D packing");
  const Wrapped wrapped = wrap(periodic);
  ChainGraph graph(wrapped.position, periodic.radius, wrapped.h,
                   largest_gap * mean_radius(periodic.radius));
  for (const Candidate& candidate : find_candidates(graph, wrapped.n))
    if (const auto layout = lay_out(candidate, graph, wrapped))
      return assemble(periodic, wrapped, graph, *layout);
  throw Error(GRAINLAW_BAD_PACKING,
              "no closed frame of near-contacts fits this packing; it is too loose or too small");
}

}  // namespace grainlaw::core
