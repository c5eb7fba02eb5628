// Saved bytes that are damaged, cut, lengthened, of another material, or rubbish.
#include "seal.hpp"
#include "support.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

namespace grainlaw::test {
namespace {

using Bytes = std::vector<std::byte>;

class bad_bytes : public testing::Test {
 protected:
  bad_bytes() : state_(material()) {
    stress(state_, compressed);
    state_.commit();
    saved_ = state_.save();
  }

  void expect_bad(std::span<const std::byte> bytes, const std::string& what) {
    // Loaded into another state than they are of, so that a change would be seen.
    expect_refused(grainlaw_state_load(fresh_.get(), bytes.data(), bytes.size()),
                   GRAINLAW_BAD_BYTES, what);
  }

  void TearDown() override { EXPECT_TRUE(same_bits(before_, fresh_.save())); }

  State state_;
  Bytes saved_;
  State fresh_{material()};
  Bytes before_ = fresh_.save();
};

TEST_F(bad_bytes, any_changed_byte_is_told) {
  std::minstd_rand random(1);
  for (std::size_t k = 0; k < saved_.size(); ++k) {
    Bytes damaged = saved_;
    damaged[k] ^= static_cast<std::byte>(1 + random() % 255);
    expect_bad(damaged, "byte " + std::to_string(k));
  }
}

TEST_F(bad_bytes, any_other_length_is_told) {
  Bytes bytes = saved_;
  for (std::size_t size = 0; size < saved_.size(); size += size < 256 ? 1 : 37)
    expect_bad(std::span(bytes).first(size), "length " + std::to_string(size));
  for (const std::size_t more : {1U, 8U, 21U, 1000U}) {
    bytes = saved_;
    bytes.resize(saved_.size() + more);
    expect_bad(bytes, "longer by " + std::to_string(more));
  }
}

TEST_F(bad_bytes, rubbish_is_told) {
  std::minstd_rand random(2);
  for (int k = 0; k < 200; ++k) {
    Bytes rubbish(random() % 400);
    for (auto& byte : rubbish) byte = static_cast<std::byte>(random() % 256);
    // Half of them look like saved states at first.
    if (k % 2 == 0)
      std::copy_n(saved_.begin(), std::min<std::size_t>(rubbish.size(), 12), rubbish.begin());
    rubbish.reserve(1);  // never null
    expect_bad(rubbish, "rubbish " + std::to_string(k));
  }
}

TEST_F(bad_bytes, of_another_material_are_told) {
  std::string text = read_text(material_path);
  text.replace(text.find("ratio = 0.8"), 11, "ratio = 0.7");
  State other(Material::parse(text, data_directory));
  const auto before = other.save();
  expect_refused(grainlaw_state_load(other.get(), saved_.data(), saved_.size()),
                 GRAINLAW_WRONG_MATERIAL, "another ratio");
  EXPECT_TRUE(same_bits(before, other.save()));
}

TEST_F(bad_bytes, do_not_fit_a_short_buffer) {
  Bytes buffer(saved_.size(), std::byte{7});
  for (const std::size_t capacity : {std::size_t{0}, std::size_t{1}, saved_.size() - 1}) {
    std::size_t size = capacity;
    expect_refused(grainlaw_state_save(state_.get(), buffer.data(), &size),
                   GRAINLAW_BUFFER_TOO_SMALL, std::to_string(capacity));
    EXPECT_EQ(size, capacity);
    EXPECT_EQ(buffer[0], std::byte{7});
  }
}

void put(Bytes& bytes, std::size_t offset, double value) {
  std::memcpy(bytes.data() + offset, &value, sizeof value);
  seal(bytes);
}

TEST(bad_numbers, of_any_size_give_a_finite_answer_that_can_be_saved_or_none) {
  const std::string contact =
      "contact = { law = 'frictional', young = 6e8, ratio = 0.8, friction = 0.5 }\n";
  for (const std::string& packing :
       {"dimension = 2\nthickness = 0.1\npacking = { generator = 'hexagonal', columns = 3, rows = "
        "2, "
        "radius = 5e-3, pressure = 1e5, radius_spread = 0.02, seed = 1 }\n" +
            contact,
        "dimension = 3\npacking = { generator = 'fcc', cells = [1, 1, 1], radius = 5e-3, pressure "
        "= "
        "1e5 }\n" +
            contact}) {
    State state(Material::parse(packing, "/"));
    const Bytes good = state.save();
    int answers = 0;
    int overflows = 0;
    for (std::size_t offset = 24; offset + 16 <= good.size(); ++offset) {
      for (const double number : {1e308, 1e200, 1e155, 1e100, 1e30, -1e10, 1e-300}) {
        Bytes bytes = good;
        put(bytes, offset, number);
        if (grainlaw_state_load(state.get(), bytes.data(), bytes.size()) != GRAINLAW_OK) continue;
        auto F = state.measure(GRAINLAW_DEFORMATION_GRADIENT);
        F[1] += 1e-4;
        std::array<double, 81> A{};
        std::array<double, 9> P{};
        grainlaw_report report = grainlaw_report_default();
        const auto evaluate = [&] {
          return grainlaw_evaluate(state.get(), F.data(), GRAINLAW_WANT_TANGENT_EXACT, P.data(),
                                   A.data(), &report);
        };
        const auto status = evaluate();
        EXPECT_GE(status, 0);
        for (const double p : P) EXPECT_TRUE(std::isfinite(p)) << offset << ' ' << number;
        for (const double a : A) EXPECT_TRUE(std::isfinite(a)) << offset << ' ' << number;
        if (std::string(report.message).starts_with("numbers too large")) {
          ++overflows;
          state.load(good);  // the cure that the manual names
          F = state.measure(GRAINLAW_DEFORMATION_GRADIENT);
          EXPECT_EQ(evaluate(), GRAINLAW_OK) << offset << ' ' << number;
          state.revert();
        }
        if (status != GRAINLAW_OK) continue;
        ++answers;
        state.commit();
        const Bytes saved = state.save();
        EXPECT_EQ(grainlaw_state_load(state.get(), saved.data(), saved.size()), GRAINLAW_OK)
            << offset << ' ' << number;
      }
    }
    EXPECT_GT(answers, 100);
    EXPECT_GT(overflows, 0);
  }
}

}  // namespace
}  // namespace grainlaw::test
