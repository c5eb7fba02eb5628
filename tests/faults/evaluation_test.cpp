// Every allocation of an evaluation fails in turn: it is told, nothing changes, and the same call
// then has the same answer.
#include "allocator.hpp"
#include "materials.hpp"

#include <cstddef>
#include <cstring>
#include <thread>
#include <vector>

namespace grainlaw::core::test {
namespace {

constexpr Tensor target{1.0002, 1e-4, -2e-4, 0.9995};

struct Answer {
  grainlaw_status status = GRAINLAW_INTERNAL_FAULT;
  Tensor stress{};
  Tangent tangent{};
  grainlaw_report report = grainlaw_report_default();

  bool operator==(const Answer& other) const {  // bit for bit
    return status == other.status && std::memcmp(&stress, &other.stress, sizeof stress) == 0 &&
           std::memcmp(&tangent, &other.tangent, sizeof tangent) == 0 &&
           std::memcmp(&report, &other.report, sizeof report) == 0;
  }
};

Answer evaluate(grainlaw_state& state, unsigned want) {
  Answer answer;
  answer.status = grainlaw_evaluate(&state, target.data(), want, answer.stress.data(),
                                    answer.tangent.data(), &answer.report);
  return answer;
}

std::vector<std::byte> saved(const grainlaw_state& state) {
  std::vector<std::byte> bytes(state.point.state.saved_size());
  state.point.state.save(bytes);
  return bytes;
}

// A thread of its own has no memory of earlier evaluations.
template <class Body>
void in_new_thread(Body&& body) {
  std::thread(std::forward<Body>(body)).join();
}

// How many allocations were refused.
long refuse_every_allocation(const std::shared_ptr<const Material>& material, unsigned want,
                             Refuse how) {
  Answer expected;
  in_new_thread([&] {
    grainlaw_state state{AnyState(material)};
    expected = evaluate(state, want);
  });
  EXPECT_EQ(expected.status, GRAINLAW_OK) << expected.report.message;
  bool refused = true;
  long k = 0;
  while (refused && !testing::Test::HasFailure()) {
    ++k;
    in_new_thread([&] {
      grainlaw_state state{AnyState(material)};
      Answer answer;
      refused = with_refused_allocation(k, how, [&] { answer = evaluate(state, want); }).refused;
      if (refused) {
        EXPECT_EQ(answer.status, GRAINLAW_OUT_OF_MEMORY) << "allocation " << k;
        EXPECT_STREQ(answer.report.message, grainlaw_status_text(GRAINLAW_OUT_OF_MEMORY));
        EXPECT_EQ(answer.stress, Tensor{}) << "allocation " << k;
        EXPECT_EQ(grainlaw_commit(&state), GRAINLAW_NO_TRIAL) << "allocation " << k;
        EXPECT_EQ(saved(state), saved(grainlaw_state{AnyState(material)})) << "allocation " << k;
      }
      EXPECT_TRUE(evaluate(state, want) == expected) << "after allocation " << k;
    });
  }
  return k - 1;
}

TEST(evaluation_without_memory, is_told_and_the_next_one_has_the_same_answer) {
  long refused = 0;
  for (const auto& [name, material] : every_material()) {
    SCOPED_TRACE(name);
    const bool chain = material->solver.method == Method::direct;
    refused += refuse_every_allocation(material, chain ? unsigned{GRAINLAW_WANT_TANGENT_EXACT} : 0U,
                                       Refuse::one);
  }
  std::printf("allocations refused: %ld\n", refused);
  RecordProperty("refused", std::to_string(refused));
}

TEST(evaluation_without_memory, is_told_when_there_is_none_left_either) {
  const auto material = make_material(describe(small_packing(), rough_law()));
  EXPECT_GT(refuse_every_allocation(material, GRAINLAW_WANT_TANGENT_EXACT, Refuse::rest), 100);
  EXPECT_GT(refuse_every_allocation(material, GRAINLAW_WANT_TANGENT_PERTURBED, Refuse::rest), 100);
}

}  // namespace
}  // namespace grainlaw::core::test
