// Numbers as little-endian bytes, in an envelope of kind, version and checksum.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace grainlaw::core {

// Envelope of saved bytes: letters, version and a final XXH3 of everything before. Damage and
// another version are told apart.
struct SavedKind {
  const char* name;  // name in messages
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

// Writer into a buffer that the caller has made large enough.
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
  // Reserves the next bytes for others to fill.
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

// Reader of bytes whose size the caller has checked.
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
  // Reads a finite number. Throws Error (BAD_BYTES) for a NaN or an infinity.
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

inline constexpr SavedKind saved_state{
    "saved state", {'G', 'R', 'A', 'I', 'N', 'L', 'A', 'W'}, 2, 6};

// Whether bytes begin with the letters of a kind.
[[nodiscard]] bool begin_as(std::span<const std::byte> bytes, const SavedKind& kind);

// Throws Error (BAD_BYTES, WRONG_VERSION) unless the bytes, any of any length, are complete and of
// this kind.
void check_envelope(std::span<const std::byte> bytes, const SavedKind& kind);

}  // namespace grainlaw::core
