// Nodes in groups, one node per lane of the widest registers; nodes of a group have similar numbers
// of contacts. Half contacts of a group lie in rows: a row has one half contact of every node.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainlaw::core {

// Rows of a group.
struct HalfContactRows {
  std::uint32_t first, count;
};

template <std::size_t lanes>
class HalfContactSlots {
 public:
  // Sorts the particles of contacts i[c], j[c], each a node of its own, by the number of contacts
  // that are `near` (empty: all); equal ones stay in `order` unless it is empty.
  void sort(std::span<const std::int32_t> i, std::span<const std::int32_t> j, std::size_t particles,
            std::span<const std::int32_t> order, std::span<const char> near);
  // Row of the next half contact of a particle; each is asked for once after sort().
  [[nodiscard]] std::size_t next_row(std::size_t particle) {
    return rows_[slot_[particle] / lanes].first + count_[particle]++;
  }

  [[nodiscard]] std::span<const HalfContactRows> groups() const { return rows_; }
  [[nodiscard]] std::size_t row_count() const { return rows_.back().first + rows_.back().count; }
  // Position of a particle: lanes x group + lane.
  [[nodiscard]] std::uint32_t slot(std::size_t particle) const { return slot_[particle]; }

 private:
  std::vector<HalfContactRows> rows_;
  std::vector<std::uint32_t> count_, near_count_, first_slot_, slot_;
};

}  // namespace grainlaw::core
