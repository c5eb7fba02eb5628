// Sums of contact forces over the contacts of every node, node by node. Adding contact by contact
// would wait for the last sum on the same particle.
#pragma once

#include "base/simd.hpp"
#include "contact/records.hpp"
#include "math/dimension.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainlaw::core {

template <int D>
class ContactSums {
 public:
  // Arranges contacts i[c], j[c] of particles; node[p] is the node of particle p.
  void arrange(std::span<const std::int32_t> i, std::span<const std::int32_t> j,
               std::span<const int> node, std::size_t nodes);

  // Computes sums[q] = sum of values[c] over contacts with j on node q, plus `sign` times that over
  // contacts with i on it.
  void add_up(std::span<const ForceRecord<D>> values, const ForceRecord<D>& sign,
              std::span<ForceRecord<D>> sums) const;
  // Sums stiffnesses over the contacts of every node, without sign.
  void add_up(std::span<const StiffnessRecord<D>> values, std::span<StiffnessRecord<D>> sums) const;

  // Calls take(q, sum) once per node, instead of storing the sum.
  template <class Take>
  GRAINLAW_INLINE void for_each(std::span<const ForceRecord<D>> values, const ForceRecord<D>& sign,
                                Take&& take) const {
    for_each_record(values.empty() ? nullptr : &values.data()->x, &sign.x, take);
  }

  // Calls take(q, sum) with records of `lanes` doubles each.
  template <class Take>
  GRAINLAW_INLINE void for_each_record(const double* records, const double* sign,
                                       Take&& take) const {
    using Record = simd::Lanes<lanes>;
    const Record sign_of_i = simd::load<lanes>(sign);
    const std::uint32_t* contact = contact_.data();
    const std::uint32_t* node = node_.data();
    for (const Run& run : runs_) {
      for (std::size_t q = 0; q < run.nodes; ++q) {
        Record on_i{};
        Record on_j{};
        for (std::size_t k = 0; k < run.as_i; ++k) {
          on_i += simd::load<lanes>(records + lanes * std::size_t{*contact++});
        }
        for (std::size_t k = 0; k < run.as_j; ++k) {
          on_j += simd::load<lanes>(records + lanes * std::size_t{*contact++});
        }
        take(std::size_t{*node++}, on_j + sign_of_i * on_i);
      }
    }
  }

 private:
  static constexpr std::size_t lanes = Dimension<D>::lanes;
  // Run of nodes with equal numbers of contacts, so that branches of the loops are predictable.
  struct Run {
    std::uint32_t nodes, as_i, as_j;
  };
  std::vector<Run> runs_;
  std::vector<std::uint32_t> node_;     // in this order
  std::vector<std::uint32_t> contact_;  // of each node, first those with the node as i
  std::vector<std::uint32_t> as_i_, as_j_, begin_, ends_;
};

}  // namespace grainlaw::core
