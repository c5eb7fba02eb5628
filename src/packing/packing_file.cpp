#include "packing/packing_file.hpp"

#include "error.hpp"
#include "packing/csv_table.hpp"
#include "packing/frame.hpp"
#include "packing/neighbours.hpp"
#include "packing/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

namespace grainlaw {

namespace {

constexpr std::int64_t largest_shift = 32767;
constexpr std::int64_t no_partner = -1;

using Ids = std::unordered_map<std::int64_t, int>;

enum ParticleColumn : std::size_t { id, x, y, r, role, partner, frame_order };
enum ContactColumn : std::size_t { i, j, shift_x, shift_y, fn, ftx, fty, moment, bonded, bond_gap };
enum CellColumn : std::size_t { h00, h01, h10, h11, thickness, rho };

void read_cell(const std::string& path, Packing& packing) {
  CsvTable<6> table(path, {"H00", "H01", "H10", "H11", "thickness", "rho"});
  table.require(h00, rho);
  if (!table.next()) table.fail("expected one line of numbers after the header");
  packing.cell = {table.real(h00), table.real(h01), table.real(h10), table.real(h11)};
  packing.thickness = table.positive(thickness);
  if (table.has(rho)) packing.density = table.positive(rho);
  const auto& h = packing.cell;
  const double area = h[0] * h[3] - h[1] * h[2];
  if (!(area > 0) || !std::isfinite(area))
    table.fail(fmt::format("found a cell of area {} m2, expected det H > 0", area));
  if (table.next()) table.fail("expected one line of numbers after the header, found another");
}

// What the particle file says of the frame, before it is one.
struct FrameRows {
  std::map<std::int64_t, int> particle_at;  // frame_order -> particle
  int corners = 0;
  std::map<int, std::int64_t> partner_id;  // edge particle -> id
};

template <class Table>
void read_frame_row(const Table& table, int particle, FrameRows& rows) {
  if (table.text(role) == "inner") return;
  const bool corner = table.text(role) == "corner";
  if (!corner && table.text(role) != "edge") table.complain(role, "inner, edge or corner");
  if (!rows.particle_at.emplace(table.integer(frame_order), particle).second)
    table.complain(frame_order, "a place that no other particle has");
  if (corner) {
    ++rows.corners;
  } else {
    rows.partner_id.emplace(particle, table.integer(partner));
  }
}

// A hole in the chain lets the smallest particle through.
void check_holes(const Packing& packing) {
  const auto& boundary = packing.frame->boundary;
  const std::size_t n = packing.size();
  const double smallest = *std::min_element(packing.radius.begin(), packing.radius.end());
  for (std::size_t q = 0; q < boundary.size(); ++q) {
    const auto a = static_cast<std::size_t>(boundary[q]);
    const auto b = static_cast<std::size_t>(boundary[(q + 1) % boundary.size()]);
    const double gap = std::hypot(packing.position[b] - packing.position[a],
                                  packing.position[n + b] - packing.position[n + a]) -
                       packing.radius[a] - packing.radius[b];
    if (!(gap < 2 * smallest))
      throw Error(GRAINLAW_BAD_PACKING,
                  fmt::format("frame: the boundary has a hole of {} m after frame_order {}, which "
                              "lets particles of radius {} m through; expected neighbours in the "
                              "boundary to be near-contacts",
                              gap, q, smallest));
  }
}

// Opposite sides are copies when their edges name partners; sides without an edge do as the others.
void find_copies(const FrameRows& rows, Frame& frame) {
  const auto corner = corner_places(frame);
  const auto given = [&](std::size_t side) {
    const std::size_t end = side < 3 ? corner[side + 1] : frame.boundary.size();
    int partners = 0;
    for (std::size_t q = corner[side] + 1; q < end; ++q)
      partners += rows.partner_id.at(frame.boundary[q]) != no_partner ? 1 : 0;
    return std::pair(static_cast<int>(end - corner[side]) - 1, partners);
  };
  std::array<int, 2> edges{}, partners{};  // of left and right, bottom and top
  for (std::size_t side = 0; side < 4; ++side) {
    const auto [count, named] = given(side);
    edges[(side + 1) % 2] += count;
    partners[(side + 1) % 2] += named;
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t by = edges[k] > 0 ? k : 1 - k;
    frame.copies[k] = edges[by] == 0 || partners[by] > 0;
  }
}

void build_frame(const std::string& path, const FrameRows& rows, const Ids& ids, Packing& packing) {
  const auto wrong = [&](const std::string& message) {
    throw Error(GRAINLAW_BAD_PACKING, fmt::format("{}: {}", path, message));
  };
  if (rows.corners != 4)
    wrong(fmt::format("found {} particles of role 'corner', expected 4", rows.corners));
  std::int64_t place = 0;
  for (const auto& [order, particle] : rows.particle_at)
    if (order != place++)
      wrong(fmt::format("frame_order has no {}, expected 0 to {} without a gap", place - 1,
                        rows.particle_at.size() - 1));
  Frame frame;
  std::size_t corners = 0;
  for (const auto& [order, particle] : rows.particle_at) {
    frame.boundary.push_back(particle);
    if (!rows.partner_id.contains(particle)) frame.corner[corners++] = particle;
  }
  packing.frame = std::move(frame);
  try {
    check_holes(packing);
    find_copies(rows, *packing.frame);
    complete_frame(packing);
  } catch (const Error& error) {
    wrong(error.what());
  }
  for (std::size_t q = 0; q < packing.frame->boundary.size(); ++q) {
    const auto given = rows.partner_id.find(packing.frame->boundary[q]);
    if (given == rows.partner_id.end()) continue;
    const auto found = ids.find(given->second);
    const int partner = found == ids.end() ? -1 : found->second;
    const bool none = packing.frame->partner[q] < 0;
    if (none ? given->second != no_partner : partner != packing.frame->partner[q])
      wrong(fmt::format("the particle at frame_order {} has partner {}, expected its opposite copy "
                        "(or -1 on both sides that are no copies)",
                        q, given->second));
  }
}

// The neighbour search numbers cells: no particle is further from the first than half of what it
// counts to, or so far from the origin that its digits are lost.
template <class Table>
void check_place(const Table& table, const Packing& packing, double y_first, double y_last) {
  constexpr double furthest_apart = 16000, furthest = 1e8;  // [cells]
  const auto& h = packing.cell;
  const double area = h[0] * h[3] - h[1] * h[2];
  const auto cells = [&](double dx, double dy) {
    return std::max(std::abs(h[3] * dx - h[1] * dy), std::abs(h[0] * dy - h[2] * dx)) / area;
  };
  const double x_first = packing.position.front();
  const double x_last = packing.position.back();
  if (const double away = cells(x_last, y_last); !(away <= furthest))
    table.fail(fmt::format("the centre is {:.3g} cells from the origin, expected at most {:g}",
                           away, furthest));
  if (const double away = cells(x_last - x_first, y_last - y_first); !(away <= furthest_apart))
    table.fail(fmt::format("the centre is {:.3g} cells from the first, expected at most {:g}", away,
                           furthest_apart));
}

Ids read_particles(const std::string& path, Packing& packing) {
  CsvTable<7> table(path, {"id", "x", "y", "r", "role", "partner", "frame_order"});
  const bool framed = table.has(role) || table.has(partner) || table.has(frame_order);
  table.require(id, framed ? frame_order + 1 : role);
  Ids ids;
  std::vector<double> ys;
  FrameRows frame;
  while (table.next()) {
    const auto particle = static_cast<int>(packing.radius.size());
    if (!ids.emplace(table.integer(id), particle).second)
      table.complain(id, "an id that no other particle has");
    packing.position.push_back(table.real(x));
    ys.push_back(table.real(y));
    check_place(table, packing, ys.front(), ys.back());
    packing.radius.push_back(table.positive(r));
    if (framed) read_frame_row(table, particle, frame);
  }
  if (ids.empty()) table.fail("found no particle");
  packing.position.insert(packing.position.end(), ys.begin(), ys.end());
  if (framed) build_frame(path, frame, ids, packing);
  return ids;
}

double branch_length(const Packing& packing, const InitialContact& contact) {
  const auto a = static_cast<std::size_t>(contact.i);
  const auto b = static_cast<std::size_t>(contact.j);
  const auto& h = packing.cell;
  const std::size_t n = packing.size();
  const double s0 = contact.shift[0];
  const double s1 = contact.shift[1];
  return std::hypot(packing.position[b] - packing.position[a] + h[0] * s0 + h[1] * s1,
                    packing.position[n + b] - packing.position[n + a] + h[2] * s0 + h[3] * s1);
}

// Particles whose centres lie in one another are no packing, but lengths in different units.
void check_sizes(const std::string& path, const Ids& ids, const Packing& packing) {
  const auto id_of = [&](std::int32_t p) {
    return std::ranges::find(ids, p, &Ids::value_type::second)->first;
  };
  const auto wrong = [&](const std::string& what) {
    throw Error(GRAINLAW_BAD_PACKING, fmt::format("{}: {}; expected all lengths in m", path, what));
  };
  const auto& h = packing.cell;
  const double area = h[0] * h[3] - h[1] * h[2];
  const double height = area / std::max(std::hypot(h[0], h[2]), std::hypot(h[1], h[3]));
  const auto largest = std::ranges::max_element(packing.radius);
  if (!packing.frame && *largest > height)
    wrong(fmt::format("particle {} of radius {:g} m is larger than the cell, {:g} m high",
                      id_of(static_cast<std::int32_t>(largest - packing.radius.begin())), *largest,
                      height));
  std::vector<NeighbourPair> pairs;
  const std::size_t n = packing.size();
  NeighbourSearch().find(n, packing.position.data(), packing.radius.data(),
                         packing.frame ? nullptr : h.data(), 0, pairs);
  for (const NeighbourPair& pair : pairs) {
    const InitialContact contact{pair.i, pair.j, {pair.shift[0], pair.shift[1]}};
    const double length = branch_length(packing, contact);
    const double r = packing.radius[static_cast<std::size_t>(pair.i)];
    const double s = packing.radius[static_cast<std::size_t>(pair.j)];
    if (length < std::max(r, s))
      wrong(fmt::format("particles {} and {} of radii {:g} and {:g} m are {:g} m apart",
                        id_of(pair.i), id_of(pair.j), r, s, length));
  }
}

void read_contacts(const std::string& path, const Ids& ids, Packing& packing) {
  CsvTable<10> table(path, {"i", "j", "shift_x", "shift_y", "fn", "ftx_on_j", "fty_on_j", "moment",
                            "bonded", "bond_gap"});
  table.require(i, fty + 1);
  const auto particle = [&](std::size_t column) {
    const auto found = ids.find(table.integer(column));
    if (found == ids.end()) table.complain(column, "the id of a particle");
    return found->second;
  };
  const auto shift = [&](std::size_t column) {
    const std::int64_t value = table.integer(column);
    if (value > largest_shift || value < -largest_shift) table.complain(column, "at most 32767 cells");
    if (value != 0 && packing.frame) table.complain(column, "0, since a frame has no images");
    return static_cast<int>(value);
  };
  using Key = std::array<int, 4>;
  std::map<Key, std::pair<unsigned, InitialContact>> contacts;
  while (table.next()) {
    InitialContact contact{particle(i),
                           particle(j),
                           {shift(shift_x), shift(shift_y)},
                           table.real(fn),
                           {table.real(ftx), table.real(fty)}};
    if (table.has(moment)) contact.moment = table.real(moment);
    if (table.has(bonded)) {
      if (const auto flag = table.integer(bonded); flag != 0 && flag != 1)
        table.complain(bonded, "0 or 1");
      contact.bonded = table.integer(bonded) == 1;
    }
    if (table.has(bond_gap)) contact.bond_gap = table.real(bond_gap);
    if (contact.i > contact.j ||
        (contact.i == contact.j &&
         std::pair(contact.shift[0], contact.shift[1]) < std::pair(0, 0))) {
      std::swap(contact.i, contact.j);
      contact.shift = {-contact.shift[0], -contact.shift[1]};
      contact.tangential_force = {-contact.tangential_force[0], -contact.tangential_force[1]};
      contact.moment = -contact.moment;
    }
    if (contact.i == contact.j && contact.shift[0] == 0 && contact.shift[1] == 0)
      table.fail(fmt::format("a particle (id {}) in contact with itself", table.text(i)));
    const double reach = packing.radius[static_cast<std::size_t>(contact.i)] +
                         packing.radius[static_cast<std::size_t>(contact.j)];
    const double length = branch_length(packing, contact);
    if (!(length < 1.5 * reach))
      table.fail(
          fmt::format("centres are {} m apart, radii add up to {} m: these do not touch; "
                      "expected x_j - x_i + H shift to be the branch",
                      length, reach));
    const Key key = {contact.i, contact.j, contact.shift[0], contact.shift[1]};
    const auto [other, fresh] = contacts.emplace(key, std::pair(table.line(), contact));
    if (!fresh) table.fail(fmt::format("the contact of line {} again", other->second.first));
  }
  for (const auto& [key, value] : contacts) packing.contacts.push_back(value.second);
}

// Per particle, the text of its columns role, partner and frame_order.
std::vector<std::string> frame_columns(const Packing& packing) {
  std::vector<std::string> text(packing.size(), ",inner,-1,-1");
  const Frame& frame = *packing.frame;
  for (std::size_t q = 0; q < frame.boundary.size(); ++q) {
    const int p = frame.boundary[q];
    const bool corner = std::ranges::find(frame.corner, p) != frame.corner.end();
    text[static_cast<std::size_t>(p)] =
        fmt::format(",{},{},{}", corner ? "corner" : "edge", frame.partner[q], q);
  }
  return text;
}

}  // namespace

Packing read_packing(const PackingPaths& paths) {
  Packing packing;
  read_cell(paths.cell, packing);
  const Ids ids = read_particles(paths.particles, packing);
  check_sizes(paths.particles, ids, packing);
  if (!paths.contacts.empty()) read_contacts(paths.contacts, ids, packing);
  return packing;
}

void write_packing(const std::string& prefix, const Packing& packing) {
  // fmt prints the shortest digits that read back to the same bits.
  const std::size_t n = packing.size();
  const auto framed = packing.frame ? frame_columns(packing) : std::vector<std::string>(n);
  fmt::memory_buffer text;
  auto out = fmt::appender(text);
  fmt::format_to(out, "id,x,y,r{}\n", packing.frame ? ",role,partner,frame_order" : "");
  for (std::size_t p = 0; p < n; ++p)
    fmt::format_to(out, "{},{},{},{}{}\n", p, packing.position[p], packing.position[n + p],
                   packing.radius[p], framed[p]);
  std::array<TextFile, 3> files;
  files[0] = {prefix + "_particles.csv", fmt::to_string(text)};

  text.clear();
  const auto& contacts = packing.contacts;
  const bool moments =
      std::any_of(contacts.begin(), contacts.end(), [](const auto& c) { return c.moment != 0; });
  const bool bonds = std::any_of(contacts.begin(), contacts.end(),
                                 [](const auto& c) { return c.bonded.has_value(); });
  fmt::format_to(out, "i,j,shift_x,shift_y,fn,ftx_on_j,fty_on_j{}{}\n", moments ? ",moment" : "",
                 bonds ? ",bonded,bond_gap" : "");
  for (const InitialContact& c : contacts) {
    fmt::format_to(out, "{},{},{},{},{},{},{}", c.i, c.j, c.shift[0], c.shift[1], c.normal_force,
                   c.tangential_force[0], c.tangential_force[1]);
    if (moments) fmt::format_to(out, ",{}", c.moment);
    if (bonds) fmt::format_to(out, ",{},{}", c.bonded.value_or(false) ? 1 : 0, c.bond_gap);
    fmt::format_to(out, "\n");
  }
  files[1] = {prefix + "_contacts.csv", fmt::to_string(text)};

  text.clear();
  const auto& h = packing.cell;
  fmt::format_to(out, "H00,H01,H10,H11,thickness,rho\n{},{},{},{},{},{}\n", h[0], h[1], h[2], h[3],
                 packing.thickness, packing.density);
  files[2] = {prefix + "_cell.csv", fmt::to_string(text)};
  write_texts(files);
}

}  // namespace grainlaw
