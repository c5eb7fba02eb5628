// D >= P >= T: what the minimum of the stored energy W orders, and what it does not. At one F each condition
// searches the minimum in a space that contains the space of the one before, D in P in T. A law that has a
// potential thus has W_D >= W_P >= W_T at the lowest minima. Nothing follows for stresses, the derivatives of
// W with respect to F. A law with friction has no potential.

#include "evidence/papers/liu2017_boundary/boundary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace verification {
namespace {

// Packings of one kind under one law.
struct Group {
  const char* prefix;  // of the cases, before the condition and the size
  const char* law;
  const char* path;
  std::vector<int> sizes;
};

const std::array<Group, 6>& groups() {
  static const std::array<Group, 6> all{
      {{"order_regular_smooth_", "pushes only", "hexagonal", {30, 99}},
       {"order_regular_bonds_", "bonds that hold", "square", {25, 100, 225}},
       {"figure_05_", "frictional", "square", {25, 100, 225}},
       {"order_irregular_smooth_", "pushes only", "irregular", {37, 120, 228}},
       {"order_irregular_bonds_", "bonds that hold", "irregular", {37, 120, 228, 444, 650}},
       {"figure_10_", "frictional", "irregular", {37, 120, 228, 444, 650}}}};
  return all;
}

}  // namespace

void study_order(PaperStudy& study) {
  Table table(
      "D >= P >= T, shares of the steps",
      {"packings", "law", "particles[-]", "pair", "steps[-]", "until_F12[-]", "stored_energy[-]",
       "stored_and_dissipated[-]", "stress_norm[-]", "mean_stress_ratio[-]"});
  const PaperUnits units = read_units(study.scenes / "pack_228.toml");
  for (const Group& group : groups()) {
    for (const int size : group.sizes) {
      const auto run = [&](const char* condition) {
        return study.run(fmt::format("{}{}{}", group.prefix, condition, size));
      };
      const std::array runs{run("D"), run("P"), run("T")};
      constexpr std::array<const char*, 2> pairs{"D; P", "P; T"};
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        if (!runs[k] || !runs[k + 1]) continue;
        const Order order = compare(*runs[k], *runs[k + 1], units);
        if (order.steps == 0) continue;
        table.row({group.path, group.law, static_cast<double>(size), pairs[k],
                   static_cast<double>(order.steps), order.until, order.energy_share,
                   order.spent_share, order.share, order.mean_ratio});
        study.facts.add(k == 0 ? fmt::format("order.{}{}.D_over_P", group.prefix, size)
                               : fmt::format("order.{}{}.P_over_T", group.prefix, size),
                        order.share);
      }
    }
  }
  table.print();
  table.write(study.results / "order.csv");
}

}  // namespace verification
