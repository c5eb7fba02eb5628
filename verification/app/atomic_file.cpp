#include "app/atomic_file.hpp"

#include "app/library.hpp"

#include <string>
#include <vector>

namespace verification {
namespace {

// One run writes a file: its temporary name need not be unique, and a leftover of a killed run is
// replaced.
constexpr grainlaw::core::Writing at_once{.wait = false, .alone = true};
constexpr grainlaw::core::Writing on_disk{.wait = true, .alone = true};

}  // namespace

void write_atomically(const std::filesystem::path& path, std::string_view bytes) {
  as<ComputationError>([&] { grainlaw::core::write_text(path.string(), bytes, on_disk); });
}

void write_together(std::initializer_list<NewFile> files) {
  std::vector<grainlaw::core::TextFile> texts;
  for (const NewFile& file : files) texts.push_back({file.path.string(), std::string(file.bytes)});
  as<ComputationError>([&] { grainlaw::core::write_together(texts, on_disk); });
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  as<ComputationError>([&] { grainlaw::core::write_text(path.string(), bytes, at_once); });
}

void sync_file(const std::filesystem::path& path) {
  as<ComputationError>([&] { grainlaw::core::sync_file(path.string()); });
}

GrowingFile::GrowingFile(const std::filesystem::path& path)
    : file_(as<ComputationError>([&] { return grainlaw::core::GrowingFile(path.string()); })) {}

GrowingFile::GrowingFile(const std::filesystem::path& path, std::uintmax_t length)
    : file_(as<ComputationError>(
          [&] { return grainlaw::core::GrowingFile(path.string(), length); })) {}

void GrowingFile::append(std::string_view bytes) {
  as<ComputationError>([&] { file_.append(bytes); });
}

}  // namespace verification
