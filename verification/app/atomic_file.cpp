#include "app/atomic_file.hpp"

#include "app/library.hpp"
#include "app/own_files.hpp"

#include <exception>
#include <string>
#include <vector>

namespace verification {
namespace {

void write(std::initializer_list<NewFile> files, grainlaw::core::Writing writing,
           Content content = Content::whole) {
  std::vector<grainlaw::core::TextFile> texts;
  for (const auto& [path, bytes] : files) {
    list_before(path, bytes, content);
    texts.push_back({path.string(), std::string(bytes), written_first(path).string()});
  }
  as<ComputationError>([&] { grainlaw::core::write_together(texts, writing); });
}

}  // namespace

void write_atomically(const std::filesystem::path& path, std::string_view bytes) {
  write({{path, bytes}}, {.wait = true});
}

void write_together(std::initializer_list<NewFile> files) { write(files, {.wait = true}); }

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  write({{path, bytes}}, {.wait = false});
}

void sync_file(const std::filesystem::path& path) {
  as<ComputationError>([&] { grainlaw::core::sync_file(path.string()); });
}

GrowingFile::GrowingFile(const std::filesystem::path& path, std::string_view beginning)
    : file_(as<ComputationError>([&] {
        write({{path, beginning}}, {.wait = false}, Content::beginning);
        const std::string name = path.string();
        return std::filesystem::is_regular_file(path)
                   ? grainlaw::core::GrowingFile(name, beginning.size())
                   : grainlaw::core::GrowingFile(name);  // e.g. /dev/null
      })) {}

GrowingFile::GrowingFile(const std::filesystem::path& path, std::uintmax_t length)
    : file_(as<ComputationError>([&] {
        list_beginning(path, length);
        return grainlaw::core::GrowingFile(path.string(), length);
      })) {}

GrowingFile::~GrowingFile() {
  try {
    list_as_it_is(file_.path());
  } catch (const std::exception&) {  // its beginning is listed
  }
}

void GrowingFile::append(std::string_view bytes) {
  as<ComputationError>([&] { file_.append(bytes); });
}

}  // namespace verification
