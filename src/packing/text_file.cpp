#include "packing/text_file.hpp"

#include "error.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace grainlaw {

namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[noreturn]] void fail(const std::string& path, const char* what) {
  throw Error(GRAINLAW_FILE_ERROR,
              fmt::format("{}: cannot be {}: {}", path, what, std::strerror(errno)));
}

}  // namespace

std::string read_text(const std::string& path) {
  const File file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) fail(path, "read");
  std::string text;
  char block[1 << 14];
  for (std::size_t count; (count = std::fread(block, 1, sizeof block, file.get())) > 0;)
    text.append(block, count);
  if (std::ferror(file.get()) != 0) fail(path, "read");
  return text;
}

void write_text(const std::string& path, std::string_view text) {
  const File file(std::fopen(path.c_str(), "wb"), &std::fclose);
  if (!file || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() ||
      std::fflush(file.get()) != 0)
    fail(path, "written");
}

}  // namespace grainlaw
