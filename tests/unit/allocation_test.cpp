// After warm-up an evaluation allocates nothing. A program of its own: it counts every operator
// new.
#include "boundary_support.hpp"
#include "law_support.hpp"
#include "sphere_support.hpp"

#include <malloc.h>

#include <cstdlib>
#include <new>

namespace {

bool counting = false;
long count = 0;
long live_bytes = 0;

void* allocate_or_null(std::size_t size, std::size_t alignment) {
  void* memory = alignment == 0 ? std::malloc(size)
                                : std::aligned_alloc(
                                      alignment, (size + alignment - 1) / alignment * alignment);
  if (counting) {
    ++count;
    live_bytes += static_cast<long>(malloc_usable_size(memory));
  }
  return memory;
}

void release(void* memory) {
  if (counting) live_bytes -= static_cast<long>(malloc_usable_size(memory));
  std::free(memory);
}

void* allocate(std::size_t size, std::size_t alignment) {
  void* memory = allocate_or_null(size, alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size, 0); }
void* operator new[](std::size_t size) { return allocate(size, 0); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return allocate_or_null(size, 0);
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }

namespace grainlaw::core::test {
namespace {

constexpr double strain = 2e-4;

Tensor after(int increments) {
  return {1 + 0.4 * strain * increments, 0, 0, 1 - strain * increments};
}

// Allocations of every evaluation of `increments`, committed one after the other.
std::vector<long> allocations(State& state, TangentKind kind, int first, int last) {
  std::vector<long> result;
  state.set_time_step(1e-5);
  for (int k = first; k <= last; ++k) {
    const Tensor F = after(k);
    Evaluation at;
    count = 0;
    counting = true;
    at.status = state.evaluate(F.data(), kind, at.stress.data(), at.tangent.data(), at.report);
    counting = false;
    result.push_back(count);
    EXPECT_EQ(at.status, GRAINLAW_OK);
    EXPECT_TRUE(state.commit());
  }
  return result;
}

constexpr int warm_up = 2;  // the first increments fill the committed and the trial configuration
constexpr int last = 10;
const std::vector<long> none(last - warm_up, 0);

std::vector<long> allocations_after_warm_up(const MaterialDescription& description,
                                            TangentKind kind) {
  State state(make_material(description));
  allocations(state, kind, 1, warm_up);
  return allocations(state, kind, warm_up + 1, last);
}

TEST(allocation, is_counted) {
  count = 0;
  counting = true;
  const auto memory = std::make_unique<std::vector<double>>(100);
  counting = false;
  EXPECT_EQ(count, 2);
  EXPECT_EQ(memory->size(), 100U);
}

std::vector<MaterialDescription> descriptions() {
  std::vector<MaterialDescription> all;
  for (const auto& law : {rough_law(), locked_law(), smooth_law()}) {
    for (const auto boundary : {BoundaryType::periodic_cell, BoundaryType::frame_p}) {
      all.push_back(describe(reference_packing(), law, boundary, 1e-8));
    }
  }
  for (const auto& law : {rolling_law(), hertz_law(), rolling_hertz_law(), bonded_law(1)}) {
    all.push_back(describe_law(reference_packing(), law, BoundaryType::periodic_cell, 1e-8));
  }
  all.push_back(
      describe_law(reference_packing(), compressive_law(), BoundaryType::periodic_cell, 1e-8));
  for (const auto boundary : {BoundaryType::frame_d, BoundaryType::frame_t}) {
    all.push_back(describe(small_packing(), rough_law(), boundary, 1e-8));
  }
  all.push_back(describe_layer(small_packing(), -1e5));
  for (const auto boundary : {BoundaryType::periodic_cell, BoundaryType::frame_p}) {
    all.push_back(describe(reference_packing(), rough_law(), boundary, 1e-8));
    all.back().solver.inertia = true;
  }
  return all;
}

TEST(allocation, does_not_happen_after_warm_up_by_similar_increments) {
  for (const auto& description : descriptions()) {
    EXPECT_EQ(allocations_after_warm_up(description, TangentKind::none), none);
  }
}

TEST(allocation, does_not_happen_with_a_tangent_either) {
  for (const auto& description : descriptions()) {
    EXPECT_EQ(allocations_after_warm_up(description, TangentKind::exact), none);
    EXPECT_EQ(allocations_after_warm_up(description, TangentKind::elastic), none);
  }
}

TEST(allocation, does_not_happen_on_a_path_that_was_gone_before) {
  for (auto description : descriptions()) {
    for (const double limit : {1.0, 0.05}) {
      description.solver.increment_limit = limit;
      const auto material = make_material(description);
      State before(material);
      allocations(before, TangentKind::exact, 1, last);
      State state(material);
      allocations(state, TangentKind::exact, 1, warm_up);
      EXPECT_EQ(allocations(state, TangentKind::exact, warm_up + 1, last), none);
    }
  }
}

TEST(allocation, of_a_state_is_at_most_250_bytes_a_disc_with_bonds_and_drag) {
  const Packing packing = reference_packing();
  MaterialDescription description =
      describe_law(packing, bonded_law(1), BoundaryType::periodic_cell, 1e-8);
  description.solver.viscosity.number = 1e-3;
  const auto material = make_material(description);
  State first(material);  // takes the memory of the thread
  allocations(first, TangentKind::exact, 1, last);
  live_bytes = 0;
  counting = true;
  State state(material);
  for (int k = 1; k <= last; ++k) {
    Evaluation at;
    at.status = state.evaluate(after(k).data(), TangentKind::exact, at.stress.data(),
                               at.tangent.data(), at.report);
    EXPECT_EQ(at.status, GRAINLAW_OK);
    EXPECT_TRUE(state.commit());
  }
  counting = false;
  EXPECT_GT(live_bytes, 0);
  EXPECT_LE(live_bytes, 250 * static_cast<long>(packing.radius.size()));
}

TEST(allocation, does_not_happen_in_the_reference_methods) {
  MaterialDescription description =
      describe(small_packing(60), rough_law(), BoundaryType::frame_p, 1e-5);
  description.solver.method = Method::published;
  EXPECT_EQ(allocations_after_warm_up(description, TangentKind::none), none);
  description.boundary.method = BoundaryMethod::servo;
  EXPECT_EQ(allocations_after_warm_up(description, TangentKind::none), none);
  description.boundary.type = BoundaryType::frame_t;
  description.boundary.servo.tolerance = 1e-4;
  EXPECT_EQ(allocations_after_warm_up(description, TangentKind::none), none);
}

TEST(allocation, does_not_happen_with_spheres_either) {
  using namespace sphere_test;
  for (const double drag : {0.0, 1e-3}) {
    MaterialDescription description = sphere_test::describe(1e-8);
    description.solver.viscosity.number = drag;
    grainlaw::core::State<3> state(make_material<3>(description));
    for (int k = 1; k <= last; ++k) {
      const Deformation F{1 + 0.4 * strain * k, 0, 0, 0, 1 + 0.4 * strain * k, 0, 0, 0,
                          1 - strain * k};
      Deformation stress{};
      Tensor4<3> tangent{};
      grainlaw_report report{};
      count = 0;
      counting = true;
      const auto status =
          state.evaluate(F.data(), TangentKind::exact, stress.data(), tangent.data(), report);
      counting = false;
      EXPECT_EQ(status, GRAINLAW_OK);
      EXPECT_TRUE(k <= warm_up || count == 0) << count << " with drag " << drag << " at " << k;
      EXPECT_TRUE(state.commit());
    }
  }
}

}  // namespace
}  // namespace grainlaw::core::test
