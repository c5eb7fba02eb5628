#include "dns/repeat.hpp"

#include "app/atomic_file.hpp"
#include "app/library.hpp"
#include "app/packing_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace verification {
namespace {

// A particle of a frame that is not a copy, or the copy `of` p: particle `first` shifted by lattice
// vectors.
struct Copy {
  int first = 0;
  std::array<int, 2> shift{};
};

// Right and upper sides are copies of left and lower ones.
std::vector<Copy> find_copies(const FramePacking& frame) {
  std::vector<Copy> copies(frame.size());
  for (std::size_t p = 0; p < copies.size(); ++p) copies[p].first = static_cast<int>(p);
  const auto at = [&](std::size_t index) {
    return static_cast<std::size_t>(frame.boundary[index % frame.boundary.size()]);
  };
  const auto [c0, c1, c2, c3] = frame.corner;
  for (std::size_t q = c1; q <= c2; ++q)
    copies[at(q)] = {frame.boundary[(frame.boundary.size() - (q - c1)) % frame.boundary.size()],
                     {1, 0}};
  // The upper right corner is already placed through the right side; its first copy is the upper
  // left one.
  for (std::size_t q = c2; q <= c3; ++q) {
    const Copy below = copies[at(c1 - (q - c2))];
    copies[at(q)] = {below.first, {below.shift[0], below.shift[1] + 1}};
  }
  return copies;
}

class Repeated {
 public:
  Repeated(const FramePacking& frame, int columns, int rows)
      : frame_(frame), copies_(find_copies(frame)), columns_(columns), rows_(rows) {
    result_.thickness = frame.thickness;
    result_.density = frame.density;
    result_.cell = {columns * frame.cell[0], rows * frame.cell[1], columns * frame.cell[2],
                    rows * frame.cell[3]};
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) add_copy(column, row);
    set_boundary();
    for (const auto& [pair, contact] : contacts_) result_.contacts.push_back(contact);
  }

  FramePacking take() { return std::move(result_); }

 private:
  // Particle p of the copy in this column and row.
  int particle(int p, int column, int row) {
    const Copy& copy = copies_[static_cast<std::size_t>(p)];
    const std::array key{copy.first, column + copy.shift[0], row + copy.shift[1]};
    const auto [found, fresh] = number_.emplace(key, static_cast<int>(result_.size()));
    if (fresh) {
      const auto first = static_cast<std::size_t>(copy.first);
      const auto& h = frame_.cell;
      result_.x.push_back(frame_.x[first] + h[0] * key[1] + h[1] * key[2]);
      result_.y.push_back(frame_.y[first] + h[2] * key[1] + h[3] * key[2]);
      result_.radius.push_back(frame_.radius[first]);
    }
    return found->second;
  }

  void add_copy(int column, int row) {
    for (std::size_t p = 0; p < frame_.size(); ++p) particle(static_cast<int>(p), column, row);
    for (FrameContact contact : frame_.contacts) {
      contact.i = particle(contact.i, column, row);
      contact.j = particle(contact.j, column, row);
      if (contact.i > contact.j) {
        std::swap(contact.i, contact.j);
        for (double& force : contact.tangential_force) force = -force;
        contact.moment = -contact.moment;
      }
      contacts_[{contact.i, contact.j}] = contact;
    }
  }

  void set_boundary() {
    const auto& corner = frame_.corner;
    auto& boundary = result_.boundary;
    const auto add_side = [&](std::size_t side, int column, int row) {
      const std::size_t end = side < 3 ? corner[side + 1] : frame_.boundary.size();
      for (std::size_t q = corner[side]; q < end; ++q)
        boundary.push_back(particle(frame_.boundary[q], column, row));
    };
    for (std::size_t side = 0; side < 4; ++side) {
      result_.corner[side] = boundary.size();
      const bool along = side % 2 == 0;
      const int count = along ? columns_ : rows_;
      for (int k = 0; k < count; ++k) {
        const int at = side < 2 ? k : count - 1 - k;
        if (along)
          add_side(side, at, side == 0 ? 0 : rows_ - 1);
        else
          add_side(side, side == 3 ? 0 : columns_ - 1, at);
      }
    }
  }

  const FramePacking& frame_;
  std::vector<Copy> copies_;
  int columns_, rows_;
  std::map<std::array<int, 3>, int> number_;
  std::map<std::pair<int, int>, FrameContact> contacts_;
  FramePacking result_;
};

// Role, id of the opposite copy and place of every particle.
std::vector<std::string> frame_columns(const FramePacking& frame) {
  std::vector<std::string> text(frame.size(), "inner,-1,-1");
  const auto [c0, c1, c2, c3] = frame.corner;
  const std::size_t count = frame.boundary.size();
  for (std::size_t q = 0; q < count; ++q) {
    const bool corner = q == c0 || q == c1 || q == c2 || q == c3;
    const std::size_t opposite = q < c1   ? c3 - q
                                 : q < c2 ? (count - (q - c1)) % count
                                 : q < c3 ? c1 - (q - c2)
                                          : c1 + (count - q);
    text[static_cast<std::size_t>(frame.boundary[q])] = fmt::format(
        "{},{},{}", corner ? "corner" : "edge", corner ? -1 : frame.boundary[opposite], q);
  }
  return text;
}

}  // namespace

FramePacking read_frame(const std::string& prefix) {
  const PackingTables packing = read_packing_tables(prefix);
  const CsvTable &particles = packing.particles, &contacts = packing.contacts, &cell = packing.cell;
  const auto wrong = [&](const std::string& found) {
    throw InputError(
        fmt::format("{}_particles.csv: found {}, expected a frame whose opposite "
                    "sides are copies of each other",
                    prefix, found));
  };
  if (!packing.framed()) wrong("no column frame_order");
  FramePacking frame;
  frame.x = particles["x"];
  frame.y = particles["y"];
  frame.radius = particles["r"];
  std::copy_n(packing.h.begin(), 4, frame.cell.begin());
  frame.thickness = cell["thickness"][0];
  if (cell.has("rho")) frame.density = cell["rho"][0];
  std::size_t corners = 0;
  for (const std::size_t p : packing.boundary) {
    // Every edge particle of copied sides has a partner, and no corner has one.
    if (particles["partner"][p] < 0) {
      if (corners < 4) frame.corner[corners] = frame.boundary.size();
      ++corners;
    }
    frame.boundary.push_back(static_cast<int>(p));
  }
  if (corners != 4 || frame.corner[0] != 0)
    wrong(fmt::format("{} particles of the boundary without a partner", corners));
  const auto [c0, c1, c2, c3] = frame.corner;
  if (c1 - c0 != c3 - c2 || c2 - c1 != frame.boundary.size() - c3) wrong("sides that differ");
  // Under a boundary that does not couple copies, the reference alone has copies.
  if (particles.has("reference_x")) {
    const auto& h = frame.cell;
    for (const std::size_t a : packing.boundary) {
      const double partner = particles["partner"][a];
      if (partner < 0) continue;
      const std::size_t b = packing.number.at(partner);
      const double dx = std::abs(frame.x[b] - frame.x[a]), dy = std::abs(frame.y[b] - frame.y[a]);
      const double off = std::min(std::hypot(dx - std::abs(h[0]), dy - std::abs(h[2])),
                                  std::hypot(dx - std::abs(h[1]), dy - std::abs(h[3])));
      if (off > 1e-9 * (std::abs(h[0]) + std::abs(h[3]))) wrong("sides that moved on their own");
    }
  }
  const bool moments = contacts.has("moment"), bonds = contacts.has("bonded");
  for (std::size_t c = 0; c < contacts.rows(); ++c) {
    FrameContact contact;
    contact.i = static_cast<int>(packing.pairs[c].first);
    contact.j = static_cast<int>(packing.pairs[c].second);
    contact.normal_force = contacts["fn"][c];
    contact.tangential_force = {contacts["ftx_on_j"][c], contacts["fty_on_j"][c]};
    if (moments) contact.moment = contacts["moment"][c];
    if (bonds) contact.bonded = contacts["bonded"][c] != 0;
    if (bonds) contact.bond_gap = contacts["bond_gap"][c];
    frame.contacts.push_back(contact);
  }
  return frame;
}

void write_frame(const FramePacking& frame, const std::string& prefix) {
  const std::vector<std::string> columns = frame_columns(frame);
  std::string particles = "id,x,y,r,role,partner,frame_order\n";
  for (std::size_t p = 0; p < frame.size(); ++p)
    particles +=
        fmt::format("{},{},{},{},{}\n", p, frame.x[p], frame.y[p], frame.radius[p], columns[p]);

  const auto any = [&](auto&& has) {
    return std::any_of(frame.contacts.begin(), frame.contacts.end(), has);
  };
  const bool moments = any([](const FrameContact& c) { return c.moment != 0; });
  const bool bonds = any([](const FrameContact& c) { return c.bonded.has_value(); });
  std::string text = fmt::format("i,j,shift_x,shift_y,fn,ftx_on_j,fty_on_j{}{}\n",
                                 moments ? ",moment" : "", bonds ? ",bonded,bond_gap" : "");
  for (const FrameContact& c : frame.contacts) {
    text += fmt::format("{},{},0,0,{},{},{}", c.i, c.j, c.normal_force, c.tangential_force[0],
                        c.tangential_force[1]);
    if (moments) text += fmt::format(",{}", c.moment);
    if (bonds) text += fmt::format(",{},{}", c.bonded.value_or(false) ? 1 : 0, c.bond_gap);
    text += '\n';
  }
  const auto& h = frame.cell;
  const std::string cell = fmt::format("H00,H01,H10,H11,thickness,rho\n{},{},{},{},{},{}\n", h[0],
                                       h[1], h[2], h[3], frame.thickness, frame.density);
  write_together({{prefix + "_particles.csv", particles},
                  {prefix + "_contacts.csv", text},
                  {prefix + "_cell.csv", cell}});
}

FramePacking repeat(const FramePacking& frame, int columns, int rows) {
  return Repeated(frame, columns, rows).take();
}

}  // namespace verification
