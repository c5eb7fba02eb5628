// Tables of points: tokens tell retries from accepted answers; bytes; bad calls.
#include "seal.hpp"
#include "support.hpp"

#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

namespace grainlaw::test {
namespace {

constexpr std::array<Tensor, 3> path{
    {{0.9996, 0.0003, -0.0001, 1.0002}, {0.9990, 0.0012, -0.0004, 1.0005}, further}};
constexpr Tensor elsewhere{1.0005, -0.0010, 0.0002, 0.9990};

// One point as its host keeps it: token and F at the start and the end of an increment.
struct Host {
  grainlaw::Table& table;
  long long element = 1;
  double start = 0, end = 0;
  Tensor F0 = identity, F1 = identity;

  Tensor evaluate(const Tensor& F, double time_step = 0) {
    Tensor P{};
    end = start;
    F1 = F;
    EXPECT_TRUE(table.evaluate(element, 1, {&end, F0.data(), F.data(), time_step, 0, P.data()}));
    return P;
  }
  void accept() {
    start = end;
    F0 = F1;
  }
};

TEST(table, gives_the_bits_of_a_host_that_says_commit) {
  grainlaw::Table table(material());
  Host host{table};
  State state(material());
  for (const Tensor& F : path) {
    host.evaluate(elsewhere);
    host.evaluate(F);
    host.evaluate(elsewhere);
    EXPECT_EQ(host.evaluate(F), stress(state, F));
    EXPECT_EQ(host.end, host.start + 1);
    host.accept();
    state.commit();
  }
  EXPECT_EQ(table.size(), 1U);
  EXPECT_EQ(table.measure(1, 1, GRAINLAW_DEFORMATION_GRADIENT),
            std::vector<double>(further.begin(), further.end()));
}

TEST(table, is_told_by_F_alone_where_the_host_keeps_no_token) {
  grainlaw::Table table(material());
  State state(material());
  Tensor F0 = identity, P{};
  for (const Tensor& F : path) {
    for (const Tensor& tried : {F, elsewhere, F})
      ASSERT_TRUE(table.evaluate(1, 2, {nullptr, F0.data(), tried.data(), 0, 0, P.data()}));
    EXPECT_EQ(P, stress(state, F));
    state.commit();
    F0 = F;
  }
}

TEST(table, finds_an_accepted_answer_again_that_was_not_the_last) {
  grainlaw::Table table(material());
  Host host{table};
  State state(material());
  host.evaluate(path[0]);
  const Host kept = host;
  host.evaluate(elsewhere);
  Tensor P{};
  double token = 0;
  const Tensor far{1.6, 0, 0, 1};
  EXPECT_EQ(table.evaluate(1, 1, {&token, identity.data(), far.data(), 0, 0, P.data()}).status,
            GRAINLAW_STEP_TOO_LARGE);
  EXPECT_EQ(token, 0);
  host.end = kept.end;
  host.F1 = path[0];
  host.accept();
  stress(state, path[0]);
  state.commit();
  EXPECT_EQ(host.evaluate(path[1]), stress(state, path[1]));
}

TEST(table, answers_at_the_start_of_the_increment_and_moves_nothing) {
  grainlaw::Table table(material());
  Host host{table};
  host.evaluate(path[0]);
  host.accept();
  Tensor P{}, expected{};
  Tangent A{}, expected_A{};
  double token = host.start;
  ASSERT_TRUE(table.evaluate(
      1, 1, {&token, host.F0.data(), nullptr, 0, GRAINLAW_WANT_TANGENT_EXACT, P.data(), A.data()}));
  EXPECT_EQ(token, host.start);
  State state(material());
  stress(state, path[0]);
  state.commit();
  ASSERT_TRUE(state.evaluate(path[0], expected, GRAINLAW_WANT_TANGENT_EXACT, expected_A));
  EXPECT_EQ(P, expected);
  EXPECT_EQ(A, expected_A);
  state.revert();
  EXPECT_EQ(host.evaluate(path[1]), stress(state, path[1]));
}

TEST(table, grows_under_threads_with_the_bits_of_one) {
  constexpr int elements = 24;
  const auto run = [&](int threads) {
    grainlaw::Table table(material());
    std::vector<Host> hosts;
    for (int e = 0; e < elements; ++e) hosts.push_back({table, e});
    std::vector<Tensor> stresses(elements);
    std::vector<std::thread> pool;
    for (int t = 0; t < threads; ++t) {
      pool.emplace_back([&, t] {
        for (std::size_t e = static_cast<std::size_t>(t); e < elements;
             e += static_cast<std::size_t>(threads)) {
          for (Tensor F : {path[0], path[1]}) {
            F[0] -= 1e-5 * static_cast<double>(e);
            stresses[e] = hosts[e].evaluate(F);
            hosts[e].accept();
          }
        }
      });
    }
    for (std::thread& thread : pool) thread.join();
    EXPECT_EQ(table.size(), static_cast<std::size_t>(elements));
    return stresses;
  };
  EXPECT_EQ(run(4), run(1));
}

TEST(table, goes_on_from_its_bytes_also_for_a_law_in_time) {
  const Material in_time = Material::parse(
      read_text(material_path) + "[solver]\nviscous_number = 1e-3\nviscous_rate = 1e-3\n",
      data_directory);
  grainlaw::Table table(in_time);
  std::vector<Host> hosts{{table, 7}, {table, -3}};
  for (Host& host : hosts) {
    host.evaluate(path[0], 0.5);
    host.accept();
    host.evaluate(path[1], 1);
    host.accept();  // which the table is not told before the next call
  }
  const auto bytes = table.save();
  grainlaw::Table loaded(in_time);
  double token = 0;
  ASSERT_TRUE(loaded.evaluate(1, 1, {&token, nullptr, identity.data()}));
  loaded.load(bytes);
  EXPECT_EQ(loaded.size(), 2U);
  EXPECT_TRUE(same_bits(loaded.save(), bytes));
  for (Host& host : hosts) {
    const Host after{loaded, host.element, host.start, host.end, host.F0, host.F1};
    Host other = after;
    EXPECT_EQ(other.evaluate(path[2], 2), host.evaluate(path[2], 2));
  }
}

class bad_table : public testing::Test {
 protected:
  bad_table() {
    host_.evaluate(path[0]);
    host_.accept();
    host_.evaluate(path[1]);
    before_ = table_.save();
  }
  void TearDown() override {
    EXPECT_TRUE(same_bits(table_.save(), before_));
    State state(material());
    for (const Tensor& F : {path[0], path[1]}) {
      stress(state, F);
      state.commit();
    }
    host_.accept();
    EXPECT_EQ(host_.evaluate(path[2]), stress(state, path[2]));
  }
  void refused(double token, const Tensor* F0, const char* text,
               grainlaw_status expected = GRAINLAW_BAD_ARGUMENT, long long element = 1) {
    grainlaw_report report = grainlaw_report_default();
    Tensor P{7, 7, 7, 7};
    const double kept = token;
    expect_refused(grainlaw_table_evaluate(table_.get(), element, 1, &token,
                                           F0 == nullptr ? nullptr : F0->data(), path[2].data(), 0,
                                           0, P.data(), nullptr, &report),
                   expected, text);
    EXPECT_NE(std::string(report.message).find(text), std::string::npos) << report.message;
    EXPECT_EQ(P, (Tensor{7, 7, 7, 7}));
    EXPECT_TRUE(token == kept || std::isnan(kept));
  }

  grainlaw::Table table_{material()};
  Host host_{table_};
  std::vector<std::byte> before_;
};

TEST_F(bad_table, tokens_of_no_known_state_are_told) {
  for (const double token : {0.0, 3.0, -1.0, 1.5, 1e300, static_cast<double>(NAN)})
    refused(token, &path[0], "gone through 1 increments");
}

TEST_F(bad_table, a_start_elsewhere_is_told) {
  refused(1, &elsewhere, "not that of the point's state");
  const Tensor none{NAN, 0, 0, 1};
  refused(1, &none, "not that of the point's state");
  refused(2, &none, "F11 is nan", GRAINLAW_NOT_FINITE);
}

TEST_F(bad_table, points_without_answers_are_told) {
  refused(1, &path[0], "no answer of this point", GRAINLAW_BAD_ARGUMENT, 5);
  ASSERT_EQ(grainlaw_table_forget(table_.get(), 5, 1), GRAINLAW_OK);
  expect_refused(grainlaw_table_forget(table_.get(), 5, 1), GRAINLAW_BAD_ARGUMENT, "forget");
  std::size_t count = 0;
  expect_refused(grainlaw_table_measure(table_.get(), 5, 1, GRAINLAW_VOLUME, nullptr, &count),
                 GRAINLAW_BAD_ARGUMENT, "measure");
  expect_refused(grainlaw_table_measure(table_.get(), 1, 1, static_cast<grainlaw_measure>(99),
                                        nullptr, &count),
                 GRAINLAW_BAD_ARGUMENT, "unknown measure");
}

TEST_F(bad_table, arguments_out_of_range_are_refused) {
  double token = 1, P[4];
  const auto call = [&](double time_step, unsigned want, grainlaw_report* report) {
    return grainlaw_table_evaluate(table_.get(), 1, 1, &token, path[0].data(), path[1].data(),
                                   time_step, want, P, nullptr, report);
  };
  for (const double time_step : {-1.0, static_cast<double>(NAN), HUGE_VAL})
    expect_refused(call(time_step, 0, nullptr), GRAINLAW_BAD_ARGUMENT, "time step");
  expect_refused(call(0, 3, nullptr), GRAINLAW_BAD_ARGUMENT, "want");
  grainlaw_report report = grainlaw_report_default();
  report.size = 8;
  expect_refused(call(0, 0, &report), GRAINLAW_BAD_REPORT, "report");
}

TEST_F(bad_table, bytes_that_are_damaged_or_of_another_material_are_told) {
  const auto load = [&](const std::vector<std::byte>& bytes, grainlaw_status expected,
                        const std::string& what) {
    std::array<char, 256> message{};
    expect_refused(grainlaw_table_load(table_.get(), bytes.data(), bytes.size(), message.data(),
                                       message.size()),
                   expected, what);
    EXPECT_STRNE(message.data(), "") << what;
  };
  for (std::size_t k = 0; k < before_.size(); k += k < 128 ? 1 : 397) {
    auto bytes = before_;
    bytes[k] ^= std::byte{1};
    load(bytes, GRAINLAW_BAD_BYTES, "byte " + std::to_string(k));
    bytes.resize(k + 1);
    load(bytes, GRAINLAW_BAD_BYTES, "length " + std::to_string(k + 1));
    if (bytes.size() < 28) continue;
    bytes = before_;
    bytes.resize(k + 1);
    seal(bytes);
    load(bytes, GRAINLAW_BAD_BYTES, "sealed length " + std::to_string(k + 1));
  }
  const Material bonded = Material::load(data_directory + "/bonded100.toml");
  grainlaw::Table other(bonded);
  double token = 0;
  ASSERT_TRUE(other.evaluate(4, 2, {&token, nullptr, identity.data()}));
  load(other.save(), GRAINLAW_WRONG_MATERIAL, "another material");
}

TEST_F(bad_table, null_pointers_and_dead_handles_are_refused) {
  alignas(16) std::array<std::uint64_t, 64> dead{};
  for (grainlaw_table* wrong :
       {static_cast<grainlaw_table*>(nullptr), reinterpret_cast<grainlaw_table*>(dead.data())}) {
    const auto expected = wrong == nullptr ? GRAINLAW_NULL_POINTER : GRAINLAW_BAD_HANDLE;
    double value = 0;
    std::size_t size = 0;
    expect_refused(grainlaw_table_evaluate(wrong, 1, 1, &value, nullptr, &value, 0, 0, nullptr,
                                           nullptr, nullptr),
                   expected, "evaluate");
    expect_refused(grainlaw_table_measure(wrong, 1, 1, GRAINLAW_VOLUME, &value, &size), expected,
                   "measure");
    expect_refused(grainlaw_table_forget(wrong, 1, 1), expected, "forget");
    expect_refused(grainlaw_table_save(wrong, nullptr, &size), expected, "save");
    expect_refused(grainlaw_table_load(wrong, &value, 8, nullptr, 0), expected, "load");
    EXPECT_EQ(grainlaw_table_size(wrong), 0U);
    grainlaw_table_destroy(wrong);
  }
  grainlaw_table* made = table_.get();
  expect_refused(grainlaw_table_create(nullptr, &made), GRAINLAW_NULL_POINTER, "create");
  EXPECT_EQ(made, nullptr);
  expect_refused(grainlaw_table_create(material().get(), nullptr), GRAINLAW_NULL_POINTER, "out");
  expect_refused(grainlaw_table_load(table_.get(), nullptr, 8, nullptr, 0), GRAINLAW_NULL_POINTER,
                 "bytes");
  expect_refused(grainlaw_table_save(table_.get(), nullptr, nullptr), GRAINLAW_NULL_POINTER,
                 "size");
}

}  // namespace
}  // namespace grainlaw::test
