#include "app/atomic_file.hpp"

#include "app/library.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace verification {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
  throw ComputationError(
      fmt::format("{}: cannot be written: {}", path.string(), std::strerror(error)));
}

class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags)
      : number_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] bool valid() const { return number_ >= 0; }
  // Each returns 0, or the error.
  int write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t count = ::write(number_, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) return errno;
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return 0;
  }
  int sync() { return ::fsync(number_) == 0 ? 0 : errno; }
  int close() {
    const int result = number_ < 0 || ::close(number_) == 0 ? 0 : errno;
    number_ = -1;
    return result;
  }

 private:
  int number_;
};

}  // namespace

void write_atomically(const std::filesystem::path& path, std::string_view bytes) {
  const std::string temporary = path.string() + ".new";
  Descriptor file(temporary, O_WRONLY | O_CREAT | O_TRUNC);
  if (!file.valid()) fail(path, errno);
  int error = file.write(bytes);
  if (error == 0) error = file.sync();
  const int closing = file.close();
  if (error == 0) error = closing;
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    fail(path, error);
  }
  // The name itself is on the disk once its directory is; some file systems cannot be asked to.
  const auto parent = path.parent_path();
  Descriptor directory(parent.empty() ? "." : parent, O_RDONLY | O_DIRECTORY);
  if (directory.valid()) directory.sync();
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  Descriptor file(path, O_WRONLY | O_CREAT | O_TRUNC);
  if (!file.valid()) fail(path, errno);
  int error = file.write(bytes);
  const int closing = file.close();
  if (error == 0) error = closing;
  if (error != 0) fail(path, error);
}

void sync_file(const std::filesystem::path& path) {
  Descriptor file(path, O_RDONLY);
  if (!file.valid()) fail(path, errno);
  if (const int error = file.sync(); error != 0 && error != EINVAL) fail(path, error);
}

}  // namespace verification
