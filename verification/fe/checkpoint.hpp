// Checkpoints: all data on which the next load step of a run depends, in one file.
#pragma once

#include "app/library.hpp"

#include <Eigen/Dense>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace verification {

template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

// Writer of a checkpoint. Values are read back in one order and type:
//
//   void save(CheckpointWriter& out) const { out.write(time_); out.write(velocity_); }
//   void restore(CheckpointReader& in) { in.read(time_); in.read(velocity_); }
class CheckpointWriter {
 public:
  template <Number T>
  void write(const T& value) {
    append(&value, sizeof value);
  }
  // Writes a vector or matrix of numbers; a list of numbers or of matrices of fixed size.
  template <class Derived>
  void write(const Eigen::PlainObjectBase<Derived>& values) {
    write(static_cast<std::int64_t>(values.rows()));
    write(static_cast<std::int64_t>(values.cols()));
    append(values.data(),
           sizeof(typename Derived::Scalar) * static_cast<std::size_t>(values.size()));
  }
  template <class T>
  void write(const std::vector<T>& values) {
    write(static_cast<std::uint64_t>(values.size()));
    for (const T& value : values) write(value);
  }
  void write(const std::string& text);

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  void append(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }

  std::string bytes_;
};

// Reader of a checkpoint. Throws InputError for an absent value or one of another size than its
// target; an empty vector, matrix or list takes any size.
class CheckpointReader {
 public:
  CheckpointReader(std::string bytes, std::filesystem::path path)
      : bytes_(std::move(bytes)), path_(std::move(path)) {}

  template <Number T>
  void read(T& value) {
    take(&value, sizeof value);
  }
  void read(bool& value) {
    const auto byte = get<unsigned char>();
    if (byte > 1) fail();
    value = byte == 1;
  }
  template <class Derived>
  void read(Eigen::PlainObjectBase<Derived>& values) {
    std::int64_t rows = 0, columns = 0;
    read(rows);
    read(columns);
    const auto fits = [](std::int64_t found, Eigen::Index fixed) {
      return fixed == Eigen::Dynamic || found == fixed;
    };
    if (!fits(rows, Derived::RowsAtCompileTime) || !fits(columns, Derived::ColsAtCompileTime) ||
        (values.size() > 0 && (rows != values.rows() || columns != values.cols())) ||
        !plausible(rows, columns))
      fail();
    values.derived().resize(rows, columns);
    take(values.data(), sizeof(typename Derived::Scalar) * static_cast<std::size_t>(values.size()));
  }
  template <class T>
  void read(std::vector<T>& values) {
    std::uint64_t size = 0;
    read(size);
    if (size > bytes_.size()) fail();
    values.resize(size);
    for (T& value : values) read(value);
  }
  void read(std::string& text);

  template <class T>
  T get() {
    T value{};
    read(value);
    return value;
  }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[noreturn]] void fail() const;

 private:
  void take(void* data, std::size_t size);
  [[nodiscard]] bool plausible(std::int64_t rows, std::int64_t columns) const;

  std::string bytes_;
  std::filesystem::path path_;
  std::size_t position_ = 0;
};

// Writes the file with version and checksum, replacing an older one atomically. Throws
// ComputationError when it cannot; the older one then stays.
void write_checkpoint(const std::filesystem::path& path, const CheckpointWriter& content);

// Reads a file. Throws InputError when it cannot be read, is damaged or of another version.
CheckpointReader read_checkpoint(const std::filesystem::path& path);

}  // namespace verification
