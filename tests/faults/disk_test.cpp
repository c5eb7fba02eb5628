// Writes that fail after ever more bytes: what was there stays, and nothing is left beside it.
#include "../temporary_directory.hpp"
#include "allocator.hpp"
#include "materials.hpp"

#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <map>

namespace grainlaw::core::test {
namespace {

using Files = std::map<std::string, std::string>;  // name -> content

Files content(const TemporaryDirectory& directory) {
  Files files;
  for (const auto& entry : std::filesystem::directory_iterator(directory.path())) {
    std::ifstream file(entry.path(), std::ios::binary);
    files[entry.path().filename()] = {std::istreambuf_iterator<char>(file), {}};
  }
  return files;
}

// Files of this process grow no longer than so many bytes, as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(std::size_t bytes) : told_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit full = before_;
    full.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &full);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, told_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  void (*told_)(int);
  rlimit before_{};
};

class writing : public testing::Test {
 protected:
  grainlaw_status write_packing_files() {
    return grainlaw_state_write_packing(&state_, prefix_.c_str());
  }
  grainlaw_status write_picture() { return grainlaw_state_write_vtk(&state_, picture_.c_str()); }

  // Calls write() under ever weaker limits, until it succeeds.
  template <class Write>
  void expect_nothing_lost_on_a_full_disk(Write&& write) {
    ASSERT_EQ(write(), GRAINLAW_OK);
    const Files old = content(directory_);
    move_on();
    constexpr std::size_t step = 499;
    std::size_t bytes = 0;
    for (;; bytes += step) {
      grainlaw_status status;
      {
        const FullDisk full(bytes);
        status = write();
      }
      if (status == GRAINLAW_OK) break;
      ASSERT_EQ(status, GRAINLAW_FILE_ERROR) << bytes << " bytes";
      ASSERT_EQ(content(directory_), old) << bytes << " bytes";
    }
    EXPECT_GT(bytes, 10 * step);
    EXPECT_NE(content(directory_), old);
    EXPECT_EQ(content(directory_).size(), old.size());
  }

  template <class Write>
  void expect_nothing_lost_without_memory(Write&& write) {
    ASSERT_EQ(write(), GRAINLAW_OK);
    const Files old = content(directory_);
    move_on();
    for (const Refuse how : {Refuse::one, Refuse::rest}) {
      for (long k = 1;; ++k) {
        grainlaw_status status = GRAINLAW_INTERNAL_FAULT;
        if (!with_refused_allocation(k, how, [&] { status = write(); }).refused) break;
        ASSERT_EQ(status, GRAINLAW_OUT_OF_MEMORY) << "allocation " << k;
        ASSERT_EQ(content(directory_), old) << "allocation " << k;
      }
      ASSERT_NE(content(directory_), old);
      ASSERT_EQ(content(directory_).size(), old.size());
      ASSERT_EQ(grainlaw_revert(&state_), GRAINLAW_OK);
      ASSERT_EQ(write(), GRAINLAW_OK);
      ASSERT_EQ(content(directory_), old);
      move_on();
    }
  }

  void move_on() {
    const Tensor F{1, 0, 0, 0.999};
    ASSERT_EQ(grainlaw_evaluate(&state_, F.data(), 0, nullptr, nullptr, nullptr), GRAINLAW_OK);
  }

  TemporaryDirectory directory_;
  const std::string prefix_ = (directory_ / "state").string();
  const std::string picture_ = prefix_ + ".vtp";
  grainlaw_state state_{AnyState(make_material(describe(small_packing(), rough_law())))};
};

TEST_F(writing, a_packing_on_a_full_disk_keeps_the_old_one) {
  expect_nothing_lost_on_a_full_disk([&] { return write_packing_files(); });
}

TEST_F(writing, a_picture_on_a_full_disk_keeps_the_old_one) {
  expect_nothing_lost_on_a_full_disk([&] { return write_picture(); });
}

TEST_F(writing, a_packing_without_memory_keeps_the_old_one) {
  expect_nothing_lost_without_memory([&] { return write_packing_files(); });
}

TEST_F(writing, a_picture_without_memory_keeps_the_old_one) {
  expect_nothing_lost_without_memory([&] { return write_picture(); });
}

TEST_F(writing, to_a_device_leaves_it_one) {
  const auto link = directory_ / "full";
  std::filesystem::create_symlink("/dev/full", link);
  EXPECT_EQ(grainlaw_state_write_vtk(&state_, link.c_str()), GRAINLAW_FILE_ERROR);
  EXPECT_EQ(grainlaw_state_write_vtk(&state_, "/dev/null"), GRAINLAW_OK);
  EXPECT_TRUE(std::filesystem::is_character_file(link));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(writing, follows_a_link) {
  ASSERT_EQ(write_picture(), GRAINLAW_OK);
  const auto link = directory_ / "link.vtp";
  std::filesystem::create_symlink("state.vtp", link);
  const auto old = content(directory_);
  move_on();
  ASSERT_EQ(grainlaw_state_write_vtk(&state_, link.c_str()), GRAINLAW_OK);
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_NE(content(directory_).at("state.vtp"), old.at("state.vtp"));
}

}  // namespace
}  // namespace grainlaw::core::test
