#include "frame/frame.hpp"

#include "base/error.hpp"
#include "frame/frame_geometry.hpp"
#include "math/tensor.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace grainlaw::core {

namespace {

[[noreturn]] void wrong(const std::string& message) {
  throw Error(GRAINLAW_BAD_PACKING, "frame: " + message);
}

Point centre(const Packing& packing, int particle) {
  const auto p = static_cast<std::size_t>(particle);
  const auto& x = undeformed(packing);
  return {x[p], x[packing.size() + p]};
}

// Undeformed lattice F^-1 H.
Tensor<2> undeformed_cell(const Packing& packing) {
  const auto& h = packing.cell;
  const auto& f = packing.frame->deformation;
  const double det = determinant<2>(f);
  return {(f[3] * h[0] - f[1] * h[2]) / det, (f[3] * h[1] - f[1] * h[3]) / det,
          (f[0] * h[2] - f[2] * h[0]) / det, (f[0] * h[3] - f[2] * h[1]) / det};
}

// Fails unless the boundary particle at place `upper` is that at `lower`, shifted by lattice vector
// k.
void check_copy(const Packing& packing, std::size_t lower, std::size_t upper, std::size_t k) {
  const int a = packing.frame->boundary[lower];
  const int b = packing.frame->boundary[upper];
  const Point x = centre(packing, a);
  const Point y = centre(packing, b);
  const auto cell = undeformed_cell(packing);
  const Point vector = {cell[k], cell[2 + k]};
  const double error = std::hypot(y[0] - x[0] - vector[0], y[1] - x[1] - vector[1]);
  if (!(error <= 1e-9 * std::hypot(vector[0], vector[1])))
    wrong(
        fmt::format("particle {} must be particle {} shifted by lattice vector {}, but is {} m off",
                    b, a, k, error));
  if (packing.radius[static_cast<std::size_t>(a)] != packing.radius[static_cast<std::size_t>(b)])
    wrong(fmt::format("particles {} and {} are copies but differ in radius", a, b));
}

// Sets A_q per unit thickness, Liu, Bosco & Suiker (2017) eq. 2. The paper's weights by radii
// average to F only between copies; weights of one half do for any polygon. F maps areas by its
// cofactors.
void set_areas(const Packing& packing, Frame& frame) {
  const std::size_t count = frame.boundary.size();
  const auto share = [&](int q, int neighbour) {
    if (!frame.copies[0] || !frame.copies[1]) return 0.5;
    const double own = packing.radius[static_cast<std::size_t>(q)];
    return own / (own + packing.radius[static_cast<std::size_t>(neighbour)]);
  };
  frame.area.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    const int q = frame.boundary[k];
    const int before = frame.boundary[(k + count - 1) % count];
    const int after = frame.boundary[(k + 1) % count];
    const Point x = centre(packing, q);
    const Point x_before = centre(packing, before);
    const Point x_after = centre(packing, after);
    const double vx =
        share(q, before) * (x[0] - x_before[0]) + share(q, after) * (x_after[0] - x[0]);
    const double vy =
        share(q, before) * (x[1] - x_before[1]) + share(q, after) * (x_after[1] - x[1]);
    const auto& f = frame.deformation;
    frame.area[k] = {f[3] * vy + f[2] * vx, -f[1] * vy - f[0] * vx};
  }
}

// Numbers identities by first appearance; copies of one particle share theirs.
void set_sources(std::size_t particles, Frame& frame) {
  std::vector<int> first_copy(particles);
  std::iota(first_copy.begin(), first_copy.end(), 0);
  const auto copy = [&](int of, int q) { first_copy[static_cast<std::size_t>(q)] = of; };
  for (std::size_t q = 0; q < frame.boundary.size(); ++q) {
    const auto p = static_cast<std::size_t>(frame.boundary[q]);
    if (frame.partner[q] >= 0 && frame.offset[p] != std::array{0, 0}) {
      copy(frame.partner[q], frame.boundary[q]);
    }
  }
  const auto [c0, c1, c2, c3] = frame.corner;
  if (frame.copies[0]) copy(c0, c1), copy(c3, c2);
  if (frame.copies[1]) copy(c0, c3), copy(frame.copies[0] ? c0 : c1, c2);
  std::vector<int> number(particles, -1);
  int sources = 0;
  frame.source.resize(particles);
  for (std::size_t p = 0; p < particles; ++p) {
    int& source = number[static_cast<std::size_t>(first_copy[p])];
    if (source < 0) source = sources++;
    frame.source[p] = source;
  }
}

void check_polygon(const Packing& packing) {
  std::vector<Point> polygon;
  for (const int q : packing.frame->boundary) polygon.push_back(centre(packing, q));
  if (!is_simple(polygon)) wrong("the boundary crosses itself");
}

}  // namespace

std::array<std::size_t, 4> corner_indices(const Frame& frame) {
  std::array<std::size_t, 4> index{};
  std::size_t k = 0;
  for (std::size_t q = 0; q < frame.boundary.size() && k < 4; ++q)
    if (frame.boundary[q] == frame.corner[k]) index[k++] = q;
  if (k < 4 || index[0] != 0)
    wrong("the boundary must start at corner 0 and pass the others in order");
  return index;
}

void complete_frame(Packing& packing) {
  if (packing.dimension != 2) wrong("only 2D packings have one");
  Frame& frame = *packing.frame;
  const auto [c0, c1, c2, c3] = corner_indices(frame);
  const std::size_t count = frame.boundary.size();
  if ((frame.copies[1] && c1 - c0 != c3 - c2) || (frame.copies[0] && c2 - c1 != count - c3))
    wrong("opposite sides differ in their particles");

  frame.partner.assign(count, -1);
  frame.offset.assign(packing.size(), {0, 0});
  frame.extent.assign(packing.size(), {0, 0});
  const auto pair_up = [&](std::size_t lower, std::size_t upper, std::size_t k) {
    const auto a = static_cast<std::size_t>(frame.boundary[lower]);
    const auto b = static_cast<std::size_t>(frame.boundary[upper]);
    check_copy(packing, lower, upper, k);
    frame.offset[b][k] = frame.extent[a][k] = frame.extent[b][k] = 1;
    return std::pair(static_cast<int>(b), static_cast<int>(a));
  };
  for (std::size_t q = c0; frame.copies[1] && q <= c1; ++q) {
    const std::size_t opposite = c3 - (q - c0);
    std::tie(frame.partner[q], frame.partner[opposite]) = pair_up(q, opposite, 1);
  }
  for (std::size_t q = c1; frame.copies[0] && q <= c2; ++q) {
    const std::size_t opposite = (count - (q - c1)) % count;
    std::tie(frame.partner[opposite], frame.partner[q]) = pair_up(opposite, q, 0);
  }
  for (const std::size_t corner : {c0, c1, c2, c3}) frame.partner[corner] = -1;

  if (!(polygon_area(packing) > 0)) wrong("the boundary must be numbered anticlockwise");
  if (!frame.copies[0] || !frame.copies[1]) check_polygon(packing);
  set_areas(packing, frame);
  set_sources(packing.size(), frame);
}

const std::vector<double>& undeformed(const Packing& packing) {
  return packing.frame->reference.empty() ? packing.position : packing.frame->reference;
}

double polygon_area(const Packing& packing) {
  std::vector<Point> polygon;
  for (const int q : packing.frame->boundary) polygon.push_back(centre(packing, q));
  return determinant<2>(packing.frame->deformation) * signed_area(polygon);
}

}  // namespace grainlaw::core
