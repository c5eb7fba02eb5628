#include "contact/contact_sums.hpp"

#include "base/capacity.hpp"
#include "base/simd.hpp"

#include <algorithm>
#include <numeric>

namespace grainlaw::core {

namespace {

using namespace simd;

// Overloads for each dimension, because templates have no clones per instruction set.
GRAINLAW_CLONES void store_sums(const ContactSums<2>& of, const double* values, const double* sign,
                                double* sums) {
  of.for_each_record(values, sign,
                     [=](std::size_t q, const Lanes<4>& sum) { store(sums + 4 * q, sum); });
}
GRAINLAW_CLONES void store_sums(const ContactSums<3>& of, const double* values, const double* sign,
                                double* sums) {
  of.for_each_record(values, sign,
                     [=](std::size_t q, const Lanes<8>& sum) { store(sums + 8 * q, sum); });
}

}  // namespace

template <int D>
void ContactSums<D>::arrange(std::span<const std::int32_t> i, std::span<const std::int32_t> j,
                             std::span<const int> node, std::size_t nodes) {
  const auto node_of = [&](std::int32_t particle) {
    return static_cast<std::size_t>(node[static_cast<std::size_t>(particle)]);
  };
  const auto zeroes = [](std::vector<std::uint32_t>& counts, std::size_t size) {
    resize_with_capacity(counts, size);
    std::fill(counts.begin(), counts.end(), 0U);
  };
  zeroes(as_i_, nodes);
  zeroes(as_j_, nodes);
  std::uint32_t most = 15;  // nearly always enough, so that the counts keep their size
  for (std::size_t c = 0; c < i.size(); ++c) {
    most = std::max(most, ++as_i_[node_of(i[c])]);
    most = std::max(most, ++as_j_[node_of(j[c])]);
  }

  // Nodes sorted by their contacts as i, then as j, by counting: first by j, then by i.
  const auto sort_by = [&](const std::vector<std::uint32_t>& count,
                           const std::vector<std::uint32_t>& from, std::vector<std::uint32_t>& to) {
    zeroes(ends_, std::size_t{most} + 2);
    for (std::size_t q = 0; q < nodes; ++q) ++ends_[count[q] + 1];
    for (std::size_t k = 1; k < ends_.size(); ++k) ends_[k] += ends_[k - 1];
    for (const std::uint32_t q : from) to[ends_[count[q]]++] = q;
  };
  resize_with_capacity(node_, nodes);
  resize_with_capacity(begin_, nodes);  // filled below; until then nodes sorted by j
  std::iota(node_.begin(), node_.end(), 0U);
  sort_by(as_j_, node_, begin_);
  sort_by(as_i_, begin_, node_);
  runs_.clear();
  runs_.reserve(nodes);
  for (const std::uint32_t q : node_) {
    if (runs_.empty() || runs_.back().as_i != as_i_[q] || runs_.back().as_j != as_j_[q]) {
      runs_.push_back({0, as_i_[q], as_j_[q]});
    }
    ++runs_.back().nodes;
  }

  std::uint32_t free = 0;
  for (const std::uint32_t q : node_) {
    begin_[q] = free;
    free += as_i_[q] + as_j_[q];
    as_j_[q] = begin_[q] + as_i_[q];  // from here on the index of the next one
  }
  resize_with_capacity(contact_, 2 * i.size());
  for (std::size_t c = 0; c < i.size(); ++c) {
    contact_[begin_[node_of(i[c])]++] = static_cast<std::uint32_t>(c);
    contact_[as_j_[node_of(j[c])]++] = static_cast<std::uint32_t>(c);
  }
}

template <int D>
void ContactSums<D>::add_up(std::span<const ForceRecord<D>> values, const ForceRecord<D>& sign,
                            std::span<ForceRecord<D>> sums) const {
  store_sums(*this, values.empty() ? nullptr : &values.data()->x, &sign.x, &sums.data()->x);
}

template <int D>
void ContactSums<D>::add_up(std::span<const StiffnessRecord<D>> values,
                            std::span<StiffnessRecord<D>> sums) const {
  alignas(64) double as_it_is[lanes];
  std::fill_n(as_it_is, lanes, 1.0);
  store_sums(*this, values.empty() ? nullptr : &values.data()->x, as_it_is, &sums.data()->x);
}

template class ContactSums<2>;
template class ContactSums<3>;

}  // namespace grainlaw::core
