// Numbers as bytes, little-endian, between what tells their kind and version and a checksum.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace grainlaw::core {

// All begin with the letters and the version and end with an XXH3 of everything before, so that
// damage and another version are told apart.
struct SavedKind {
  const char* name;  // in messages
  std::array<char, 8> letters;
  std::uint32_t version;
  std::uint32_t newest = version;  // that is read
};
inline constexpr std::size_t version_end = sizeof(SavedKind::letters) + sizeof(std::uint32_t);
inline constexpr std::size_t checksum_size = sizeof(std::uint64_t);

template <std::size_t size>
using Word = std::conditional_t<
    size == 1, std::uint8_t,
    std::conditional_t<size == 2, std::uint16_t,
                       std::conditional_t<size == 4, std::uint32_t, std::uint64_t>>>;

// The caller gives as many bytes as will be written.
class ByteWriter {
 public:
  explicit ByteWriter(std::span<std::byte> bytes) : first_(bytes.data()), next_(bytes.data()) {}

  void begin(const SavedKind& kind) {
    for (const char letter : kind.letters) put(letter);
    put(kind.version);
  }
  template <class T>
  void put(T value) {
    const auto word = std::bit_cast<Word<sizeof(T)>>(value);
    for (std::size_t k = 0; k < sizeof(T); ++k) *next_++ = static_cast<std::byte>(word >> (8 * k));
  }
  // The next bytes, for others to fill.
  std::span<std::byte> skip(std::size_t size) {
    std::byte* const from = next_;
    next_ += size;
    return {from, size};
  }
  void end();

 private:
  std::byte* first_;
  std::byte* next_;
};

// The caller has checked that the bytes suffice.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : left_(bytes) {}

  template <class T>
  T get() {
    Word<sizeof(T)> word = 0;
    for (std::size_t k = 0; k < sizeof(T); ++k)
      word = static_cast<Word<sizeof(T)>>(word | static_cast<Word<sizeof(T)>>(left_[k]) << (8 * k));
    left_ = left_.subspan(sizeof(T));
    return std::bit_cast<T>(word);
  }
  // Throws Error (BAD_BYTES) for a NaN or an infinity.
  double get_finite();
  std::span<const std::byte> take(std::size_t size) {
    const auto taken = left_.first(size);
    left_ = left_.subspan(size);
    return taken;
  }
  [[nodiscard]] std::size_t left() const { return left_.size(); }

 private:
  std::span<const std::byte> left_;
};

// Throws Error (BAD_BYTES, WRONG_VERSION) unless bytes, any of any length, are whole and of a kind.
void check_envelope(std::span<const std::byte> bytes, const SavedKind& kind);

}  // namespace grainlaw::core
