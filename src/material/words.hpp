// Structs as words of 64 bits and back, by one list of their members: each(words, members...).
#pragma once

#include "base/error.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

namespace grainlaw::core {

template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

class WordWriter {
 public:
  std::vector<std::uint64_t> words;

  template <Number T>
  void one(const T& value) {
    if constexpr (std::is_floating_point_v<T>) {
      words.push_back(std::bit_cast<std::uint64_t>(static_cast<double>(value)));
    } else {
      words.push_back(static_cast<std::uint64_t>(static_cast<std::int64_t>(value)));
    }
  }
  template <class T>
  void one(const std::vector<T>& values) {
    one(values.size());
    for (const auto& value : values) one(value);
  }
  template <class T>
  void one(const std::optional<T>& value) {
    one(value.has_value());
    if (value) one(*value);
  }
  template <class T, std::size_t size>
  void one(const std::array<T, size>& values) {
    for (const auto& value : values) one(value);
  }
  template <class T>
  void one(const T& value) {
    members(*this, value);
  }
};

// Reads any words. Throws Error (BAD_BYTES) where they end too early or are none of a struct.
class WordReader {
 public:
  explicit WordReader(std::span<const std::uint64_t> words) : left_(words) {}
  [[nodiscard]] std::size_t left() const { return left_.size(); }

  template <Number T>
  void one(T& value) {
    if (left_.empty()) fail();
    const std::uint64_t word = left_.front();
    left_ = left_.subspan(1);
    if constexpr (std::is_floating_point_v<T>) {
      value = std::bit_cast<double>(word);
    } else if constexpr (std::is_same_v<T, bool>) {
      if (word > 1) fail();
      value = word == 1;
    } else {
      value = static_cast<T>(static_cast<std::int64_t>(word));
    }
  }
  template <class T>
  void one(std::vector<T>& values) {
    std::size_t size = 0;
    one(size);
    if (size > left_.size()) fail();  // each takes one word or more
    values.resize(size);
    for (auto& value : values) one(value);
  }
  template <class T>
  void one(std::optional<T>& value) {
    bool there = false;
    one(there);
    if (there) one(value.emplace());
  }
  template <class T, std::size_t size>
  void one(std::array<T, size>& values) {
    for (auto& value : values) one(value);
  }
  template <class T>
  void one(T& value) {
    members(*this, value);
  }

 private:
  [[noreturn]] static void fail() {
    throw Error(GRAINLAW_BAD_BYTES, "saved material: its length does not fit its content");
  }

  std::span<const std::uint64_t> left_;
};

template <class Words, class... Members>
void each(Words& words, Members&... list) {
  (words.one(list), ...);
}

}  // namespace grainlaw::core
