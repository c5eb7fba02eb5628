// Files that are either the old ones or the whole new ones, whenever the process or the machine
// stops.
#pragma once

#include <filesystem>
#include <string_view>

namespace verification {

// Writes beside the file, waits until it is on the disk, then renames. Throws ComputationError with
// the reason; the old file is then as it was, and nothing is left beside it.
void write_atomically(const std::filesystem::path& path, std::string_view bytes);

// Plainly, for what can be written again. Throws ComputationError with the reason.
void write_file(const std::filesystem::path& path, std::string_view bytes);

// Waits until what was written to the file is on the disk. Throws ComputationError.
void sync_file(const std::filesystem::path& path);

}  // namespace verification
