// Checkpoints: values come back, damage is found, an older file survives a failed write.
#include "fe/checkpoint.hpp"

#include "../temporary_directory.hpp"
#include "app/atomic_file.hpp"
#include "app/own_files.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace verification {
namespace {

using grainlaw::test::TemporaryDirectory;

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void overwrite(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST(checkpoint, gives_back_what_was_written) {
  const TemporaryDirectory directory;
  const Eigen::VectorXd vector = Eigen::VectorXd::LinSpaced(7, -1, 1.0 / 3);
  Tensor tensor;
  tensor << 1, 2, 3, 4.0 / 7;
  CheckpointWriter out;
  out.write(0.1);
  out.write(std::string("two\0parts", 9));
  out.write(vector);
  out.write(std::vector<Tensor>{tensor, 2 * tensor});
  out.write(std::vector<std::vector<int>>{{1, 2}, {}, {3}});
  write_checkpoint(directory.path() / "a", out);

  CheckpointReader in = read_checkpoint(directory.path() / "a");
  EXPECT_EQ(in.get<double>(), 0.1);
  EXPECT_EQ(in.get<std::string>(), std::string("two\0parts", 9));
  EXPECT_EQ(in.get<Eigen::VectorXd>(), vector);
  const auto tensors = in.get<std::vector<Tensor>>();
  ASSERT_EQ(tensors.size(), 2u);
  EXPECT_EQ(tensors[1], 2 * tensor);
  EXPECT_EQ(in.get<std::vector<std::vector<int>>>(),
            (std::vector<std::vector<int>>{{1, 2}, {}, {3}}));
  EXPECT_THROW(in.get<char>(), InputError);
}

TEST(checkpoint, of_another_size_is_refused) {
  CheckpointWriter out;
  out.write(Eigen::VectorXd::Zero(6).eval());
  CheckpointReader in(out.bytes(), "a");
  EXPECT_THROW(in.get<Tensor>(), InputError);
  Eigen::VectorXd shorter = Eigen::VectorXd::Zero(5);
  EXPECT_THROW(CheckpointReader(out.bytes(), "a").read(shorter), InputError);
  EXPECT_EQ(shorter.size(), 5);
  CheckpointWriter matrix;
  matrix.write(Eigen::MatrixXd::Zero(3, 2).eval());
  EXPECT_THROW(CheckpointReader(matrix.bytes(), "a").get<Eigen::VectorXd>(), InputError);
  CheckpointWriter huge;
  huge.write(std::uint64_t{1} << 60);
  EXPECT_THROW(CheckpointReader(huge.bytes(), "a").get<std::vector<double>>(), InputError);
  EXPECT_THROW(CheckpointReader(huge.bytes(), "a").get<std::string>(), InputError);
}

TEST(checkpoint, that_says_neither_true_nor_false_is_refused) {
  EXPECT_THROW(CheckpointReader("\2", "a").get<bool>(), InputError);
  EXPECT_TRUE(CheckpointReader("\1", "a").get<bool>());
}

TEST(checkpoint, with_any_byte_changed_or_missing_is_refused) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "a";
  CheckpointWriter out;
  out.write(Eigen::VectorXd::Ones(3).eval());
  write_checkpoint(path, out);
  const std::string whole = contents(path);
  for (std::size_t k = 0; k < whole.size(); k += 3) {
    std::string damaged = whole;
    damaged[k] = static_cast<char>(damaged[k] ^ 1);
    overwrite(path, damaged);
    EXPECT_THROW(read_checkpoint(path), InputError) << "byte " << k;
    overwrite(path, whole.substr(0, k));
    EXPECT_THROW(read_checkpoint(path), InputError) << "length " << k;
  }
  EXPECT_THROW(read_checkpoint(directory.path() / "nothing"), InputError);
}

TEST(checkpoint, that_cannot_be_written_leaves_the_older_one) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "a";
  const OwnFiles own(OwnFiles::Others::keep);
  write_atomically(path, "old");
  // A directory where the new file would be put stands for whatever prevents it.
  const auto first = written_first(path);
  std::filesystem::create_directory(first);
  EXPECT_THROW(write_atomically(path, "new"), ComputationError);
  EXPECT_EQ(contents(path), "old");
  std::filesystem::remove(first);
  write_atomically(path, "new");
  EXPECT_EQ(contents(path), "new");
  EXPECT_FALSE(std::filesystem::exists(first));
  EXPECT_THROW(write_atomically(directory.path() / "missing" / "a", "new"), ComputationError);
}

TEST(checkpoint, full_disk_is_an_error_that_says_so) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  try {
    write_file("/dev/full", "text");
    FAIL() << "nothing was thrown";
  } catch (const ComputationError& error) {
    EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace verification
