#include "app/atomic_file.hpp"

#include "app/library.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

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

// The whole new file, beside the one that it replaces.
class Beside {
 public:
  Beside(const NewFile& file, bool wait) : name_(file.path), target_(file.path), wait_(wait) {
    struct stat old {};
    const bool exists = ::stat(name_.c_str(), &old) == 0;
    if (exists && !S_ISREG(old.st_mode)) {
      write_in_place(name_, file.bytes);
      return;
    }
    if (exists && ::access(name_.c_str(), W_OK) != 0) fail(name_, errno);
    if (exists) target_ = std::filesystem::canonical(name_);  // of a link
    temporary_ = target_.string() + ".new";
    Descriptor beside(temporary_, O_WRONLY | O_CREAT | O_TRUNC);
    if (!beside.valid()) fail(name_, errno);
    int error = beside.write(file.bytes);
    if (error == 0 && exists) error = beside.keep_mode(old.st_mode & 07777U);
    if (error == 0 && wait) error = beside.sync();
    const int closing = beside.close();
    if (error == 0) error = closing;
    if (error == 0) return;
    ::unlink(temporary_.c_str());
    fail(name_, error);
  }
  ~Beside() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  void take_place() {
    if (temporary_.empty()) return;
    if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail(name_, errno);
    temporary_.clear();
    if (!wait_) return;
    // The name itself is on the disk once its directory is; some file systems cannot be asked to.
    const auto parent = target_.parent_path();
    Descriptor directory(parent.empty() ? "." : parent, O_RDONLY | O_DIRECTORY);
    if (directory.valid()) directory.sync();
  }

 private:
  std::filesystem::path name_, target_;
  std::string temporary_;  // "" : in its place
  bool wait_;
};

}  // namespace

void write_atomically(const std::filesystem::path& path, std::string_view bytes) {
  Beside({path, bytes}, true).take_place();
}

void write_together(std::initializer_list<NewFile> files) {
  std::vector<std::unique_ptr<Beside>> whole;
  for (const NewFile& file : files) whole.push_back(std::make_unique<Beside>(file, true));
  for (const auto& file : whole) file->take_place();
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  Beside({path, bytes}, false).take_place();
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
