#include "fe/checkpoint.hpp"

#include "app/atomic_file.hpp"

#include <fmt/format.h>

#include <xxhash.h>

#include <cstring>
#include <fstream>
#include <iterator>

namespace verification {
namespace {

constexpr std::string_view magic = "grainlaw run 3\n";  // the number is the format's version

std::string header(std::string_view content) {
  const std::uint64_t sum = XXH3_64bits(content.data(), content.size());
  std::string bytes(magic);
  bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  return bytes;
}

}  // namespace

void CheckpointWriter::write(const std::string& text) {
  write(static_cast<std::uint64_t>(text.size()));
  append(text.data(), text.size());
}

void CheckpointReader::read(std::string& text) {
  std::uint64_t size = 0;
  read(size);
  if (size > bytes_.size()) fail();
  text.resize(size);
  take(text.data(), size);
}

void CheckpointReader::take(void* data, std::size_t size) {
  if (size > bytes_.size() - position_) fail();
  std::memcpy(data, bytes_.data() + position_, size);
  position_ += size;
}

bool CheckpointReader::plausible(std::int64_t rows, std::int64_t columns) const {
  const auto limit = static_cast<std::int64_t>(bytes_.size());
  return rows >= 0 && columns >= 0 && (columns == 0 || rows <= limit / columns);
}

void CheckpointReader::fail() const {
  throw InputError(
      fmt::format("{}: does not hold what this run needs; it was written by another version, or "
                  "for another run",
                  path_.string()));
}

void write_checkpoint(const std::filesystem::path& path, const CheckpointWriter& content) {
  write_atomically(path, header(content.bytes()) + content.bytes());
}

CheckpointReader read_checkpoint(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw InputError(fmt::format("{}: cannot be read", path.string()));
  if (bytes.compare(0, magic.size(), magic) != 0)
    throw InputError(
        fmt::format("{}: found something else, expected a checkpoint of this version "
                    "of grainlaw solve",
                    path.string()));
  const std::size_t start = magic.size() + sizeof(std::uint64_t);
  const std::string content = bytes.size() < start ? std::string() : bytes.substr(start);
  if (bytes.compare(0, start, header(content)) != 0)
    throw InputError(fmt::format("{}: is damaged (the checksum does not fit)", path.string()));
  return {content, path};
}

}  // namespace verification
