#include "contact/contact_sums.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace grainlaw::core {
namespace {

TEST(contact_sums, of_a_particle_among_very_many_take_memory_in_proportion) {
  constexpr std::size_t around = 200000;
  std::vector<std::int32_t> i(around, 0), j(around);
  std::iota(j.begin(), j.end(), 1);
  std::vector<int> node(around + 1);
  std::iota(node.begin(), node.end(), 0);
  ContactSums<2> sums;
  sums.arrange(i, j, node, node.size());

  std::vector<ForceRecord<2>> force(around), sum(around + 1);
  for (std::size_t c = 0; c < around; ++c) force[c].x = static_cast<double>(c % 7);
  ForceRecord<2> sign;
  sign.x = -1;
  sums.add_up(force, sign, sum);
  double all = 0;
  for (std::size_t c = 0; c < around; ++c) {
    ASSERT_EQ(sum[c + 1].x, force[c].x);
    all += force[c].x;
  }
  EXPECT_EQ(sum[0].x, -all);
}

}  // namespace
}  // namespace grainlaw::core
