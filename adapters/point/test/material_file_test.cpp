// When a material file is read, and when it is not.
#include "material_file.hpp"
#include "temporary_directory.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <thread>
#include <vector>

struct grainlaw_material {};

namespace {

std::atomic<int> reads = 0;
std::atomic<grainlaw_status> status_of_next = GRAINLAW_OK;

}  // namespace

// The part of the library that a material file needs; a read takes 20 ms.
extern "C" {

const char* grainlaw_status_text(grainlaw_status) { return ""; }
grainlaw_status grainlaw_material_load(const char* path, grainlaw_material** out, char* message,
                                       size_t size) {
  ++reads;
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  if (status_of_next != GRAINLAW_OK) {
    std::snprintf(message, size, "%s: wrong, read %d", path, reads.load());
    return status_of_next;
  }
  *out = new grainlaw_material;
  return GRAINLAW_OK;
}
void grainlaw_material_destroy(grainlaw_material* material) { delete material; }

}  // extern "C"

namespace grainlaw::test {
namespace {

class material_file : public testing::Test {
 protected:
  material_file() {
    reads = 0;
    status_of_next = GRAINLAW_OK;
    write("one");
  }
  void write(const char* text) const { std::ofstream(path) << text; }
  std::string message() {
    try {
      file.material();
    } catch (const grainlaw::StatusError& error) {
      EXPECT_EQ(error.status(), status_of_next);
      return error.what();
    }
    return {};
  }

  TemporaryDirectory directory;
  std::string path = directory / "sand.toml";
  adapters::MaterialFile file{"Sand", path.c_str(), nullptr};
};

TEST_F(material_file, is_read_once_by_all_threads) {
  std::vector<std::thread> threads;
  std::vector<const grainlaw::Material*> found(8);
  for (auto& one : found) threads.emplace_back([&] { one = &file.material(); });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(reads, 1);
  EXPECT_EQ(found, std::vector(found.size(), &file.material()));
}

TEST_F(material_file, that_is_wrong_is_read_once_and_says_the_same_to_every_point) {
  status_of_next = GRAINLAW_BAD_MATERIAL;
  for (int point = 0; point < 100; ++point) EXPECT_EQ(message(), path + ": wrong, read 1");
  EXPECT_EQ(reads, 1);
}

TEST_F(material_file, that_was_wrong_is_read_again_once_it_has_changed) {
  status_of_next = GRAINLAW_BAD_MATERIAL;
  message();
  write("three");
  EXPECT_EQ(message(), path + ": wrong, read 2");
  EXPECT_EQ(message(), path + ": wrong, read 2");
  status_of_next = GRAINLAW_OK;
  write("mended");
  EXPECT_EQ(message(), "");
  EXPECT_EQ(message(), "");
  EXPECT_EQ(reads, 3);
}

TEST_F(material_file, that_was_missing_is_read_once_it_is_there) {
  std::filesystem::remove(path);
  status_of_next = GRAINLAW_FILE_ERROR;
  for (int point = 0; point < 10; ++point) message();
  EXPECT_EQ(reads, 1);
  write("there");
  message();
  EXPECT_EQ(reads, 2);
}

// What it names may have been mended: a packing, or a disk.
TEST_F(material_file, that_was_wrong_is_read_again_after_a_hundred_times_as_long) {
  status_of_next = GRAINLAW_BAD_PACKING;
  message();
  for (int wait = 0; wait < 1000 && reads == 1; ++wait) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    message();
  }
  EXPECT_EQ(reads, 2);
}

TEST_F(material_file, a_lack_of_memory_is_not_the_files) {
  status_of_next = GRAINLAW_OUT_OF_MEMORY;
  message();
  status_of_next = GRAINLAW_OK;
  EXPECT_EQ(message(), "");
  EXPECT_EQ(reads, 2);
}

}  // namespace
}  // namespace grainlaw::test
