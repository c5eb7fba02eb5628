// A host that cancels a thread: the call comes to its end, and then the thread does.
#include "points_support.hpp"

#include <pthread.h>

#include <atomic>
#include <functional>

namespace grainlaw::test {
namespace {

struct Task {
  std::function<grainlaw_status()> call;
  std::atomic<bool> cancelled{false}, returned{false};
  grainlaw_status status = GRAINLAW_INTERNAL_FAULT;
};

void* run(void* of) {
  auto& task = *static_cast<Task*>(of);
  while (!task.cancelled) {
  }
  task.status = task.call();
  task.returned = true;
  pthread_testcancel();
  return nullptr;
}

void expect_to_end(std::function<grainlaw_status()> call) {
  Task task{std::move(call)};
  pthread_t thread;
  ASSERT_EQ(pthread_create(&thread, nullptr, run, &task), 0);
  ASSERT_EQ(pthread_cancel(thread), 0);
  task.cancelled = true;
  void* end = nullptr;
  ASSERT_EQ(pthread_join(thread, &end), 0);
  EXPECT_TRUE(task.returned);
  EXPECT_EQ(task.status, GRAINLAW_OK);
  EXPECT_EQ(end, PTHREAD_CANCELED);
}

TEST(cancelled_thread, ends_a_load_first) {
  grainlaw_material* loaded = nullptr;
  expect_to_end([&] { return grainlaw_material_load(material_path.c_str(), &loaded, nullptr, 0); });
  EXPECT_EQ(grainlaw_material_dimension(loaded), 2);
  grainlaw_material_destroy(loaded);
}

TEST(cancelled_thread, ends_a_batch_first) {
  const auto F = deformations();
  const auto many = states();
  const auto all = handles(many);
  Result found;
  expect_to_end([&] {
    return grainlaw_evaluate_batch(points, all.data(), F.data(), 0, found.P.data(), nullptr,
                                   found.status.data(), nullptr, 2);
  });
  EXPECT_TRUE(same_bits(found.P, evaluate(many, 1).P));
}

TEST(cancelled_thread, ends_a_set_first) {
  const auto F = deformations();
  Points set = make_set();
  expect_to_end([&] {
    return grainlaw_points_evaluate(set.get(), F.data(), 0, nullptr, nullptr, nullptr, nullptr, 2,
                                    nullptr);
  });
  expect_to_end([&] { return grainlaw_points_commit(set.get()); });
}

TEST(cancelled_thread, ends_an_output_first) {
  const TemporaryDirectory directory;
  const std::string prefix = (directory / "state").string();
  const State state(material());
  expect_to_end([&] { return grainlaw_state_write_packing(state.get(), prefix.c_str()); });
  expect_to_end([&] { return grainlaw_state_write_vtk(state.get(), (prefix + ".vtp").c_str()); });
}

}  // namespace
}  // namespace grainlaw::test
