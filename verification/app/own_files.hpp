// Files that the command has made, by a list beside them: it writes over no others.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace verification {

// While it lives, what the process writes is listed in the hidden directory .grainlaw beside it, with
// size and checksum. One at a time; threads may write meanwhile.
class OwnFiles {
 public:
  enum class Others { keep, write_over };
  explicit OwnFiles(Others others);
  ~OwnFiles();
  OwnFiles(const OwnFiles&) = delete;
  OwnFiles& operator=(const OwnFiles&) = delete;
};

// Whether there is a file, or a link to nothing, that its list does not have as it is now.
bool is_of_others(const std::filesystem::path& path);

// Below, nothing happens without OwnFiles.

// Before a file is written: lists what it will be, or begin with. Throws ComputationError for a file of
// others that is to be kept, and when the list cannot be written.
enum class Content { whole, beginning };
void list_before(const std::filesystem::path& path, std::string_view bytes, Content content);

// Takes a file as made by the command: as it is now, or its first bytes.
void list_as_it_is(const std::filesystem::path& path);
void list_beginning(const std::filesystem::path& path, std::uint64_t length);

// Where a file is written before it takes its place; empty: beside it.
std::filesystem::path written_first(const std::filesystem::path& path);

}  // namespace verification
