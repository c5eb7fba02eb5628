#include "base/saved_bytes.hpp"

#include "base/error.hpp"

#include <xxhash.h>

#include <cmath>
#include <cstring>
#include <string>

namespace grainlaw::core {

namespace {

std::uint64_t checksum(std::span<const std::byte> bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

}  // namespace

void ByteWriter::end() { put(checksum({first_, next_})); }

double ByteReader::get_finite() {
  const auto value = get<double>();
  if (!std::isfinite(value)) throw Error(GRAINLAW_BAD_BYTES, "saved state: not a finite number");
  return value;
}

bool begin_as(std::span<const std::byte> bytes, const SavedKind& kind) {
  return bytes.size() >= kind.letters.size() &&
         std::memcmp(bytes.data(), kind.letters.data(), kind.letters.size()) == 0;
}

void check_envelope(std::span<const std::byte> bytes, const SavedKind& kind) {
  const auto require = [&](bool condition, grainlaw_status status, const char* found) {
    if (!condition) throw Error(status, std::string(kind.name) + ": " + found);
  };
  require(bytes.size() >= version_end + checksum_size, GRAINLAW_BAD_BYTES, "truncated");
  require(begin_as(bytes, kind), GRAINLAW_BAD_BYTES, "the bytes are of something else");
  const auto content = bytes.first(bytes.size() - checksum_size);
  require(ByteReader(bytes.last(checksum_size)).get<std::uint64_t>() == checksum(content),
          GRAINLAW_BAD_BYTES, "damaged or truncated");
  const auto version = ByteReader(bytes.subspan(kind.letters.size())).get<std::uint32_t>();
  require(version >= kind.version && version <= kind.newest, GRAINLAW_WRONG_VERSION,
          "of another format version");
}

}  // namespace grainlaw::core
