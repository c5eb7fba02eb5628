// Another copy of the library in the same process, as a plug-in of the host brings along.
#include "batch_support.hpp"

#include <dlfcn.h>

#include <cstdint>

namespace grainlaw::test {
namespace {

// A file of its own, so that it is loaded beside the one this program is linked with.
class LoadedCopy {
 public:
  LoadedCopy() {
    Dl_info library{};
    if (::dladdr(reinterpret_cast<void*>(&grainlaw_version), &library) == 0) return;
    const std::filesystem::path path(library.dli_fname);
    if (path.filename().string().find("libgrainlaw") != 0) return;  // linked statically
    const auto copy = directory_ / "libgrainlaw_copy.so";
    std::filesystem::copy_file(path, copy);
    handle_ = ::dlopen(copy.c_str(), RTLD_NOW | RTLD_LOCAL);
  }
  ~LoadedCopy() { unload(); }
  LoadedCopy(const LoadedCopy&) = delete;
  LoadedCopy& operator=(const LoadedCopy&) = delete;

  [[nodiscard]] bool loaded() const { return handle_ != nullptr; }
  template <class Function>
  Function* function(Function&, const char* name) const {
    return reinterpret_cast<Function*>(::dlsym(handle_, name));
  }
  void unload() {
    if (handle_ != nullptr) ::dlclose(handle_);
    handle_ = nullptr;
  }

 private:
  TemporaryDirectory directory_;
  void* handle_ = nullptr;
};
#define OF_COPY(copy, name) (copy).function(name, #name)

TEST(loaded_copy, refuses_the_handles_of_another) {
  const LoadedCopy copy;
  if (!copy.loaded()) GTEST_SKIP() << "needs the shared library";
  State state(material());
  grainlaw_state* created = nullptr;
  EXPECT_EQ(OF_COPY(copy, grainlaw_state_create)(material().get(), &created), GRAINLAW_BAD_HANDLE);
  EXPECT_EQ(
      OF_COPY(copy, grainlaw_evaluate)(state.get(), identity.data(), 0, nullptr, nullptr, nullptr),
      GRAINLAW_BAD_HANDLE);
  OF_COPY(copy, grainlaw_state_destroy)(state.get());  // does nothing

  grainlaw_material* own = nullptr;
  ASSERT_EQ(OF_COPY(copy, grainlaw_material_load)(material_path.c_str(), &own, nullptr, 0),
            GRAINLAW_OK);
  EXPECT_EQ(grainlaw_state_create(own, &created), GRAINLAW_BAD_HANDLE);
  EXPECT_EQ(OF_COPY(copy, grainlaw_state_create)(own, &created), GRAINLAW_OK);
  EXPECT_EQ(grainlaw_revert(created), GRAINLAW_BAD_HANDLE);
  grainlaw_points* set = nullptr;
  EXPECT_EQ(grainlaw_points_create(own, 1, &set), GRAINLAW_BAD_HANDLE);
  EXPECT_EQ(OF_COPY(copy, grainlaw_points_create)(own, 1, &set), GRAINLAW_OK);
  EXPECT_EQ(grainlaw_points_commit(set), GRAINLAW_BAD_HANDLE);
  EXPECT_EQ(grainlaw_points_size(set), 0U);
  OF_COPY(copy, grainlaw_points_destroy)(set);
  OF_COPY(copy, grainlaw_state_destroy)(created);
  OF_COPY(copy, grainlaw_material_destroy)(own);
  EXPECT_EQ(grainlaw_revert(state.get()), GRAINLAW_OK);
}

TEST(loaded_copy, may_be_unloaded_after_a_batch) {
  for (int round = 0; round < 3; ++round) {
    LoadedCopy copy;
    if (!copy.loaded()) GTEST_SKIP() << "needs the shared library";
    grainlaw_material* own = nullptr;
    ASSERT_EQ(OF_COPY(copy, grainlaw_material_load)(material_path.c_str(), &own, nullptr, 0),
              GRAINLAW_OK);
    std::vector<grainlaw_state*> all(points);
    for (auto& state : all)
      ASSERT_EQ(OF_COPY(copy, grainlaw_state_create)(own, &state), GRAINLAW_OK);
    const auto F = deformations();
    Result found;
    ASSERT_EQ(
        OF_COPY(copy, grainlaw_evaluate_batch)(points, all.data(), F.data(), 0, found.P.data(),
                                               nullptr, found.status.data(), nullptr, 4),
        GRAINLAW_OK);
    for (auto* state : all) OF_COPY(copy, grainlaw_state_destroy)(state);
    OF_COPY(copy, grainlaw_material_destroy)(own);
    const auto* const code = reinterpret_cast<const void*>(OF_COPY(copy, grainlaw_version));
    copy.unload();
    Dl_info found_there{};
    EXPECT_EQ(::dladdr(code, &found_there), 0) << "still loaded";
  }
}

}  // namespace
}  // namespace grainlaw::test
