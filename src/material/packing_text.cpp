#include "material/packing_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace grainlaw::core {

namespace {

// Text of the columns role, partner and frame_order per particle.
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

std::string space_particles_text(const Packing& packing) {
  const std::size_t n = packing.size();
  const auto& x = packing.position;
  fmt::memory_buffer text;
  auto out = fmt::appender(text);
  fmt::format_to(out, "id,x,y,z,r\n");
  for (std::size_t p = 0; p < n; ++p) {
    fmt::format_to(out, "{},{},{},{},{}\n", p, x[p], x[n + p], x[2 * n + p], packing.radius[p]);
  }
  return fmt::to_string(text);
}

bool has_moments(const Packing& packing) {
  constexpr std::array<double, 3> none{};
  return std::ranges::any_of(packing.contacts, [&](const auto& c) { return c.moment != none; });
}

std::string space_contacts_text(const Packing& packing) {
  const bool moments = has_moments(packing);
  const bool bonds = packing.names_bonds;
  fmt::memory_buffer text;
  auto out = fmt::appender(text);
  fmt::format_to(out, "i,j,shift_x,shift_y,shift_z,fn,ftx_on_j,fty_on_j,ftz_on_j{}{}\n",
                 moments ? ",moment_x,moment_y,moment_z" : "", bonds ? ",bonded,bond_gap" : "");
  for (const InitialContact& c : packing.contacts) {
    const auto& f = c.tangential_force;
    fmt::format_to(out, "{},{},{},{},{},{},{},{},{}", c.i, c.j, c.shift[0], c.shift[1], c.shift[2],
                   c.normal_force, f[0], f[1], f[2]);
    if (moments) fmt::format_to(out, ",{},{},{}", c.moment[0], c.moment[1], c.moment[2]);
    if (bonds) fmt::format_to(out, ",{},{}", c.bonded ? 1 : 0, c.bond_gap);
    fmt::format_to(out, "\n");
  }
  return fmt::to_string(text);
}

std::string space_cell_text(const Packing& packing) {
  std::string header, line;
  for (std::size_t k = 0; k < 9; ++k) {
    header += fmt::format("H{}{},", k / 3, k % 3);
    line += fmt::format("{},", packing.cell[k]);
  }
  return header + "rho\n" + line + fmt::format("{}\n", packing.density);
}

}  // namespace

std::string particles_text(const Packing& packing) {
  const std::size_t n = packing.size();
  if (packing.dimension == 3) return space_particles_text(packing);
  const bool deformed = packing.frame && !packing.frame->reference.empty();
  const auto framed = packing.frame ? frame_columns(packing) : std::vector<std::string>(n);
  fmt::memory_buffer text;
  auto out = fmt::appender(text);
  fmt::format_to(out, "id,x,y,r{}{}\n", packing.frame ? ",role,partner,frame_order" : "",
                 deformed ? ",reference_x,reference_y" : "");
  for (std::size_t p = 0; p < n; ++p) {
    fmt::format_to(out, "{},{},{},{}{}", p, packing.position[p], packing.position[n + p],
                   packing.radius[p], framed[p]);
    if (deformed)
      fmt::format_to(out, ",{},{}", packing.frame->reference[p], packing.frame->reference[n + p]);
    fmt::format_to(out, "\n");
  }
  return fmt::to_string(text);
}

std::string contacts_text(const Packing& packing) {
  if (packing.dimension == 3) return space_contacts_text(packing);
  fmt::memory_buffer text;
  auto out = fmt::appender(text);
  const auto& contacts = packing.contacts;
  const bool moments = has_moments(packing);
  const bool bonds = packing.names_bonds;
  fmt::format_to(out, "i,j,shift_x,shift_y,fn,ftx_on_j,fty_on_j{}{}\n", moments ? ",moment" : "",
                 bonds ? ",bonded,bond_gap" : "");
  for (const InitialContact& c : contacts) {
    fmt::format_to(out, "{},{},{},{},{},{},{}", c.i, c.j, c.shift[0], c.shift[1], c.normal_force,
                   c.tangential_force[0], c.tangential_force[1]);
    if (moments) fmt::format_to(out, ",{}", c.moment[0]);
    if (bonds) fmt::format_to(out, ",{},{}", c.bonded ? 1 : 0, c.bond_gap);
    fmt::format_to(out, "\n");
  }
  return fmt::to_string(text);
}

std::string cell_text(const Packing& packing) {
  if (packing.dimension == 3) return space_cell_text(packing);
  const auto& h = packing.cell;
  std::string header = "H00,H01,H10,H11,thickness,rho";
  std::string line =
      fmt::format("{},{},{},{},{},{}", h[0], h[1], h[2], h[3], packing.thickness, packing.density);
  if (packing.frame && !packing.frame->reference.empty()) {
    const auto& f = packing.frame->deformation;
    header += ",F00,F01,F10,F11";
    line += fmt::format(",{},{},{},{}", f[0], f[1], f[2], f[3]);
  }
  return header + "\n" + line + "\n";
}

}  // namespace grainlaw::core
