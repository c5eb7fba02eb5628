#include "frame/frame.hpp"

#include "../data.hpp"
#include "base/error.hpp"
#include "frame/frame_geometry.hpp"
#include "generate/compaction.hpp"
#include "generate/generator.hpp"
#include "material/packing_file.hpp"
#include "packing/neighbours.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace grainlaw::core {
namespace {

Packing yade_packing() {
  const std::string data = grainlaw::test::data_file("rve400_");
  return read_packing({data + "particles.csv", data + "contacts.csv", data + "cell.csv"});
}

// The packing seen in a sheared cell, with particles moved to other cells.
Packing disguised(Packing packing, const std::array<int, 4>& lattice) {
  const auto h = packing.cell;
  const auto& m = lattice;  // new vectors in terms of the old, det 1
  packing.cell = {h[0] * m[0] + h[1] * m[2], h[0] * m[1] + h[1] * m[3], h[2] * m[0] + h[3] * m[2],
                  h[2] * m[1] + h[3] * m[3]};
  const std::size_t n = packing.size();
  const auto moved = [](int p, int k) { return (p * 7 + k * 3) % 5 - 2; };  // in new cells
  for (std::size_t p = 0; p < n; ++p) {
    const int a = moved(static_cast<int>(p), 0);
    const int b = moved(static_cast<int>(p), 1);
    packing.position[p] += packing.cell[0] * a + packing.cell[1] * b;
    packing.position[n + p] += packing.cell[2] * a + packing.cell[3] * b;
  }
  for (InitialContact& c : packing.contacts) {
    const int s0 = m[3] * c.shift[0] - m[1] * c.shift[1];
    const int s1 = -m[2] * c.shift[0] + m[0] * c.shift[1];
    c.shift = {s0 + moved(c.i, 0) - moved(c.j, 0), s1 + moved(c.i, 1) - moved(c.j, 1)};
  }
  return packing;
}

Packing consolidated(std::size_t count, double friction, std::uint64_t seed) {
  GeneratorOptions options;
  options.count = count;
  options.friction = friction;
  options.seed = seed;
  ContactLaw law;
  law.young = 6e8;
  law.ratio = 0.8;
  return consolidate(options, law);
}

Point centre(const Packing& packing, int p) {
  const auto k = static_cast<std::size_t>(p);
  return {packing.position[k], packing.position[packing.size() + k]};
}

// Touching discs on a regular triangular lattice of rows x columns, rows even.
Packing triangular(int columns, int rows) {
  Packing packing;
  std::vector<double> ys;
  for (int b = 0; b < rows; ++b)
    for (int a = 0; a < columns; ++a) {
      packing.position.push_back(a + 0.5 * (b % 2));
      ys.push_back(b * std::sqrt(0.75));
      packing.radius.push_back(0.5 + 1e-6);
    }
  packing.position.insert(packing.position.end(), ys.begin(), ys.end());
  packing.cell = {static_cast<double>(columns), 0, 0, rows * std::sqrt(0.75)};
  return packing;
}

void expect_frame_of(const Packing& periodic, const Packing& cut) {
  ASSERT_TRUE(cut.frame);
  const Frame& frame = *cut.frame;
  const std::size_t n = periodic.size();

  // Particles: the periodic ones in their order, and copies of those on the boundary.
  std::size_t edges = 0;
  for (const int partner : frame.partner) edges += static_cast<std::size_t>(partner >= 0);
  EXPECT_EQ(edges + 4, frame.boundary.size());
  EXPECT_EQ(cut.size(), n + edges / 2 + 3);
  std::map<int, int> copies;
  for (std::size_t p = 0; p < cut.size(); ++p) {
    const int source = frame.source[p];
    ++copies[source];
    if (p < n) {
      EXPECT_EQ(source, static_cast<int>(p));
    }
    EXPECT_EQ(cut.radius[p], periodic.radius[static_cast<std::size_t>(source)]);
    const Point a = centre(cut, source);
    const Point b = centre(cut, static_cast<int>(p));
    const auto& h = cut.cell;
    const auto& o = frame.offset[p];
    EXPECT_NEAR(b[0] - a[0], h[0] * o[0] + h[1] * o[1], 1e-15);
    EXPECT_NEAR(b[1] - a[1], h[2] * o[0] + h[3] * o[1], 1e-15);
  }
  EXPECT_EQ(copies.size(), n);
  for (std::size_t q = 0; q < frame.boundary.size(); ++q) {
    if (frame.partner[q] < 0) continue;
    const auto a = static_cast<std::size_t>(frame.boundary[q]);
    EXPECT_EQ(frame.source[a], frame.source[static_cast<std::size_t>(frame.partner[q])]);
  }
  for (const int corner : frame.corner)
    EXPECT_EQ(copies[frame.source[static_cast<std::size_t>(corner)]], 4);

  // The polygon is simple, as large as the cell, and holds every inner particle.
  std::vector<Point> polygon;
  std::vector<char> on_boundary(cut.size(), 0);
  for (const int q : frame.boundary) {
    polygon.push_back(centre(cut, q));
    on_boundary[static_cast<std::size_t>(q)] = 1;
  }
  EXPECT_TRUE(is_simple(polygon));
  const double volume = polygon_area(cut);
  EXPECT_NEAR(volume / (cut.cell[0] * cut.cell[3] - cut.cell[1] * cut.cell[2]), 1, 1e-13);
  for (std::size_t p = 0; p < cut.size(); ++p)
    if (on_boundary[p] == 0) {
      EXPECT_TRUE(is_inside(polygon, centre(cut, static_cast<int>(p))));
    }

  // sum A = 0 and (1/V) sum X (x) A = I.
  double sum[2] = {};
  double identity[4] = {};
  for (std::size_t q = 0; q < frame.boundary.size(); ++q) {
    const Point x = centre(cut, frame.boundary[q]);
    for (std::size_t i = 0; i < 2; ++i) {
      sum[i] += frame.area[q][i];
      for (std::size_t j = 0; j < 2; ++j) identity[2 * i + j] += x[i] * frame.area[q][j] / volume;
    }
  }
  const double length = std::sqrt(volume);
  EXPECT_NEAR(sum[0] / length, 0, 1e-14);
  EXPECT_NEAR(sum[1] / length, 0, 1e-14);
  EXPECT_NEAR(identity[0], 1, 1e-14);
  EXPECT_NEAR(identity[1], 0, 1e-14);
  EXPECT_NEAR(identity[2], 0, 1e-14);
  EXPECT_NEAR(identity[3], 1, 1e-14);
}

// Two particles of the periodic packing and the lattice vector between them.
using Bond = std::array<int, 4>;

// Weighted copies of every bond of a frame, or of the periodic packing it was cut from, that
// overlaps by more than `depth`. Particles are those of `periodic`, wherever they were moved.
std::map<Bond, double> bonds(const Packing& periodic, const Packing& packing, double depth) {
  const auto& h = periodic.cell;
  const double area = h[0] * h[3] - h[1] * h[2];
  const bool framed = packing.frame.has_value();
  const auto source = [&](int p) {
    return framed ? packing.frame->source[static_cast<std::size_t>(p)] : p;
  };
  // Lattice vectors by which a particle lies away from where it lies in `periodic`.
  const auto moved = [&](int p) {
    const Point a = centre(periodic, source(p));
    const Point b = centre(packing, p);
    const double x = b[0] - a[0];
    const double y = b[1] - a[1];
    return std::array{static_cast<int>(std::lround((h[3] * x - h[1] * y) / area)),
                      static_cast<int>(std::lround((h[0] * y - h[2] * x) / area))};
  };
  NeighbourSearch<2> search;
  std::vector<NeighbourPair<2>> pairs;
  search.find(packing.size(), packing.position.data(), packing.radius.data(),
              framed ? nullptr : h.data(), std::abs(depth), pairs);
  std::map<Bond, double> found;
  for (const NeighbourPair<2>& pair : pairs) {
    const Point a = centre(packing, pair.i);
    const Point b = centre(packing, pair.j);
    const double x = b[0] - a[0] + h[0] * pair.shift[0] + h[1] * pair.shift[1];
    const double y = b[1] - a[1] + h[2] * pair.shift[0] + h[3] * pair.shift[1];
    const double reach = packing.radius[static_cast<std::size_t>(pair.i)] +
                         packing.radius[static_cast<std::size_t>(pair.j)];
    if (reach - std::hypot(x, y) <= depth) continue;
    const auto from = moved(pair.i);
    const auto to = moved(pair.j);
    Bond bond{source(pair.i), source(pair.j), pair.shift[0] + to[0] - from[0],
              pair.shift[1] + to[1] - from[1]};
    bond = std::min(bond, Bond{bond[1], bond[0], -bond[2], -bond[3]});
    double weight = 1;
    if (framed) {
      const int count = contact_copies(*packing.frame, pair.i, pair.j);
      EXPECT_TRUE(count == 1 || count == 2);
      EXPECT_EQ(count, contact_copies(*packing.frame, pair.j, pair.i));
      weight = 1.0 / count;
    }
    found[bond] += weight;
  }
  return found;
}

// The frame's touching pairs, weighted by 1/copies, are those of the periodic packing. A pair that
// touches to within the rounding of coordinates may touch in one of them only.
void expect_same_contacts(const Packing& periodic, const Packing& cut) {
  const double rounding = 1e-12 * periodic.radius[0];
  const auto touching = bonds(periodic, periodic, rounding);
  const auto perhaps_touching = bonds(periodic, periodic, -rounding);
  const auto framed = bonds(periodic, cut, rounding);
  const auto perhaps_framed = bonds(periodic, cut, -rounding);
  EXPECT_FALSE(touching.empty());
  for (const auto& [bond, weight] : touching) {
    EXPECT_EQ(weight, 1) << bond[0] << " " << bond[1];
    const auto copies = perhaps_framed.find(bond);
    ASSERT_NE(copies, perhaps_framed.end()) << bond[0] << " " << bond[1];
    EXPECT_EQ(copies->second, 1) << bond[0] << " " << bond[1];
  }
  for (const auto& [bond, weight] : framed) {
    EXPECT_TRUE(perhaps_touching.contains(bond)) << bond[0] << " " << bond[1];
  }
}

// Love stress of the initial contacts, each with its weight.
std::array<double, 4> stress(const Packing& packing) {
  std::array<double, 4> sum{};
  const auto& h = packing.cell;
  for (const InitialContact& c : packing.contacts) {
    const Point a = centre(packing, c.i);
    const Point b = centre(packing, c.j);
    const double l[2] = {b[0] - a[0] + h[0] * c.shift[0] + h[1] * c.shift[1],
                         b[1] - a[1] + h[2] * c.shift[0] + h[3] * c.shift[1]};
    const double d = std::hypot(l[0], l[1]);
    const double weight = packing.frame ? 1.0 / contact_copies(*packing.frame, c.i, c.j) : 1.0;
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j)
        sum[2 * i + j] -= weight * (c.normal_force * l[i] / d + c.tangential_force[i]) * l[j];
  }
  return sum;
}

TEST(frame, of_the_yade_packing_is_closed_and_exact) {
  const Packing periodic = yade_packing();
  const Packing cut = cut_frame(periodic);
  expect_frame_of(periodic, cut);
  expect_same_contacts(periodic, cut);
}

TEST(frame, does_not_depend_on_how_the_cell_is_written) {
  for (const std::array<int, 4>& lattice : {std::array{1, 0, 0, 1}, std::array{1, 1, 0, 1},
                                            std::array{0, -1, 1, 0}, std::array{2, 1, 1, 1}}) {
    const Packing periodic = disguised(yade_packing(), lattice);
    const Packing cut = cut_frame(periodic);
    expect_frame_of(periodic, cut);
    expect_same_contacts(periodic, cut);
  }
}

TEST(frame, carries_the_contact_forces_with_weight_one_over_copies) {
  for (const std::array<int, 4>& lattice : {std::array{1, 0, 0, 1}, std::array{1, 1, 0, 1}}) {
    const Packing periodic = disguised(yade_packing(), lattice);
    const Packing cut = cut_frame(periodic);
    double weighted = 0;
    std::map<std::array<int, 2>, int> seen;
    for (const InitialContact& c : cut.contacts) {
      EXPECT_LT(c.i, c.j);
      EXPECT_EQ(c.shift, (std::array{0, 0, 0}));
      EXPECT_EQ((++seen[{c.i, c.j}]), 1);
      weighted += 1.0 / contact_copies(*cut.frame, c.i, c.j);
    }
    EXPECT_EQ(weighted, static_cast<double>(periodic.contacts.size()));
    const auto expected = stress(periodic);
    const auto found = stress(cut);
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(found[k], expected[k], 1e-12 * std::abs(expected[0]));
  }
}

TEST(frame, turns_forces_and_moments_with_the_order_of_a_pair) {
  Packing periodic = consolidated(40, 0.5, 1);
  double number = 0;
  for (InitialContact& c : periodic.contacts) {
    c.moment[0] = ++number;  // names the contact, and is of the sign of i before j
    c.tangential_force = {c.moment[0], 0};
  }
  const Packing cut = cut_frame(periodic);
  int turned = 0;
  for (const InitialContact& c : cut.contacts) {
    EXPECT_EQ(c.moment[0], c.tangential_force[0]);
    turned += c.moment[0] < 0 ? 1 : 0;
  }
  EXPECT_GT(turned, 0);
}

TEST(frame, copies_of_a_pair_are_those_with_the_same_branch) {
  const Packing cut = cut_frame(consolidated(40, 0, 1));
  const Frame& frame = *cut.frame;
  const auto same_branch = [&](int i, int j, int a, int b) {
    const auto offset = [&](int p) { return frame.offset[static_cast<std::size_t>(p)]; };
    const auto source = [&](int p) { return frame.source[static_cast<std::size_t>(p)]; };
    return source(i) == source(a) && source(j) == source(b) &&
           offset(j)[0] - offset(i)[0] == offset(b)[0] - offset(a)[0] &&
           offset(j)[1] - offset(i)[1] == offset(b)[1] - offset(a)[1];
  };
  // Only particles of the boundary have copies.
  for (const int i : frame.boundary)
    for (const int j : frame.boundary) {
      if (i == j) continue;
      int count = 0;
      for (const int a : frame.boundary)
        for (const int b : frame.boundary) count += same_branch(i, j, a, b) ? 1 : 0;
      ASSERT_EQ(contact_copies(frame, i, j), count) << i << " " << j;
    }
}

TEST(frame, of_regular_packings_is_found) {
  for (const auto& [columns, rows] : {std::pair(2, 2), std::pair(3, 4), std::pair(8, 8)}) {
    const Packing periodic = triangular(columns, rows);
    const Packing cut = cut_frame(periodic);
    expect_frame_of(periodic, cut);
    expect_same_contacts(periodic, cut);
  }
}

TEST(frame, of_generated_packings_is_closed_and_exact) {
  for (const std::size_t count : {10U, 40U, 100U})
    for (const double friction : {0.0, 0.5})
      for (const std::uint64_t seed : {1U, 2U}) {
        const Packing periodic = consolidated(count, friction, seed);
        const Packing cut = cut_frame(periodic);
        expect_frame_of(periodic, cut);
        expect_same_contacts(periodic, cut);
      }
}

TEST(frame, of_a_loose_packing_is_refused) {
  GeneratorOptions options;
  options.count = 60;
  EXPECT_THROW(cut_frame(scatter(options)), Error);
  Packing cut = cut_frame(yade_packing());
  EXPECT_THROW(cut_frame(cut), Error);
}

TEST(polygon, that_crosses_itself_is_not_simple) {
  EXPECT_TRUE(is_simple({{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
  EXPECT_FALSE(is_simple({{0, 0}, {1, 1}, {1, 0}, {0, 1}}));
  EXPECT_FALSE(is_simple({{0, 0}, {2, 0}, {2, 1}, {1, 0}, {0, 1}}));
  EXPECT_DOUBLE_EQ(signed_area({{0, 0}, {2, 0}, {2, 1}, {0, 1}}), 2);
  EXPECT_DOUBLE_EQ(signed_area({{0, 1}, {2, 1}, {2, 0}, {0, 0}}), -2);
  EXPECT_TRUE(is_inside({{0, 0}, {2, 0}, {2, 2}, {1, 0.5}, {0, 2}}, {0.2, 1}));
  EXPECT_FALSE(is_inside({{0, 0}, {2, 0}, {2, 2}, {1, 0.5}, {0, 2}}, {1, 1}));
}

}  // namespace
}  // namespace grainlaw::core
