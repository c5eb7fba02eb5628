#include "app/atomic_file.hpp"

#include "app/library.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

namespace verification {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
  throw ComputationError(
      fmt::format("{}: cannot be written: {}", path.string(), std::strerror(error)));
}

int open_file(const std::filesystem::path& path, int flags) {
  return ::open(path.c_str(), flags | O_CLOEXEC, 0666);
}

// 0, or the error.
int write_all(int number, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(number, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return 0;
}

class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags) : number_(open_file(path, flags)) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] bool valid() const { return number_ >= 0; }
  // Each returns 0, or the error.
  int write(std::string_view bytes) { return write_all(number_, bytes); }
  int sync() { return ::fsync(number_) == 0 ? 0 : errno; }
  int keep_mode(mode_t mode) { return ::fchmod(number_, mode) == 0 ? 0 : errno; }
  int close() {
    const int result = number_ < 0 || ::close(number_) == 0 ? 0 : errno;
    number_ = -1;
    return result;
  }

 private:
  int number_;
};

void write_in_place(const std::filesystem::path& path, std::string_view bytes) {
  Descriptor file(path, O_WRONLY | O_TRUNC);
  if (!file.valid()) fail(path, errno);
  int error = file.write(bytes);
  const int closing = file.close();
  if (error == 0) error = closing;
  if (error != 0) fail(path, error);
}

void replace(const std::filesystem::path& name, std::string_view bytes, bool wait) {
  struct stat old {};
  const bool exists = ::stat(name.c_str(), &old) == 0;
  if (exists && !S_ISREG(old.st_mode)) return write_in_place(name, bytes);
  if (exists && ::access(name.c_str(), W_OK) != 0) fail(name, errno);
  // Of a link, the file that it leads to.
  const std::filesystem::path path = exists ? std::filesystem::canonical(name) : name;
  const std::string temporary = path.string() + ".new";
  Descriptor file(temporary, O_WRONLY | O_CREAT | O_TRUNC);
  if (!file.valid()) fail(name, errno);
  int error = file.write(bytes);
  if (error == 0 && exists) error = file.keep_mode(old.st_mode & 07777U);
  if (error == 0 && wait) error = file.sync();
  const int closing = file.close();
  if (error == 0) error = closing;
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    fail(name, error);
  }
  if (!wait) return;
  // The name itself is on the disk once its directory is; some file systems cannot be asked to.
  const auto parent = path.parent_path();
  Descriptor directory(parent.empty() ? "." : parent, O_RDONLY | O_DIRECTORY);
  if (directory.valid()) directory.sync();
}

}  // namespace

void write_atomically(const std::filesystem::path& path, std::string_view bytes) {
  replace(path, bytes, true);
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  replace(path, bytes, false);
}

void sync_file(const std::filesystem::path& path) {
  Descriptor file(path, O_RDONLY);
  if (!file.valid()) fail(path, errno);
  if (const int error = file.sync(); error != 0 && error != EINVAL) fail(path, error);
}

GrowingFile::GrowingFile(const std::filesystem::path& path)
    : path_(path), number_(open_file(path, O_WRONLY | O_CREAT | O_TRUNC)) {
  if (number_ < 0) fail(path, errno);
}

GrowingFile::GrowingFile(const std::filesystem::path& path, std::uintmax_t length)
    : path_(path), number_(open_file(path, O_WRONLY | O_APPEND)), length_(length) {
  if (number_ < 0) fail(path, errno);
  if (::ftruncate(number_, static_cast<off_t>(length)) != 0) {
    const int error = errno;
    ::close(number_);
    fail(path, error);
  }
}

GrowingFile::~GrowingFile() { ::close(number_); }

void GrowingFile::append(std::string_view bytes) {
  if (const int error = write_all(number_, bytes); error != 0) {
    // Best effort: what is there of the piece would be read as the whole of it.
    if (::ftruncate(number_, static_cast<off_t>(length_)) == 0)
      ::lseek(number_, static_cast<off_t>(length_), SEEK_SET);
    fail(path_, error);
  }
  length_ += bytes.size();
}

}  // namespace verification
