// Saved bytes with a checksum that is right, as whoever writes the format themselves may make.
#pragma once

#include <xxhash.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace grainlaw::test {

inline void seal(std::vector<std::byte>& bytes) {
  const std::uint64_t checksum = XXH3_64bits(bytes.data(), bytes.size() - sizeof checksum);
  std::memcpy(bytes.data() + bytes.size() - sizeof checksum, &checksum, sizeof checksum);
}

}  // namespace grainlaw::test
