#include "packing/text_file.hpp"

#include "error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

namespace grainlaw {

namespace {

[[noreturn]] void fail(const std::string& path, const char* what, int error) {
  throw Error(GRAINLAW_FILE_ERROR,
              fmt::format("{}: cannot be {}: {}", path, what, std::strerror(error)));
}

class Descriptor {
 public:
  Descriptor(const std::string& path, int flags)
      : number_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] bool valid() const { return number_ >= 0; }
  // Each returns 0, or the error.
  int write(std::string_view text) {
    while (!text.empty()) {
      const ssize_t count = ::write(number_, text.data(), text.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) return errno;
      text.remove_prefix(static_cast<std::size_t>(count));
    }
    return 0;
  }
  int keep_mode(mode_t mode) { return ::fchmod(number_, mode) == 0 ? 0 : errno; }
  int sync() { return ::fsync(number_) == 0 ? 0 : errno; }
  int close() {
    const int result = number_ < 0 || ::close(number_) == 0 ? 0 : errno;
    number_ = -1;
    return result;
  }

 private:
  int number_;
};

// A new file beside the one that it will be.
class Beside {
 public:
  Beside(const TextFile& file, bool sync) : path_(file.path), target_(file.path) {
    struct stat old {};
    const bool exists = ::stat(path_.c_str(), &old) == 0;
    if (exists && !S_ISREG(old.st_mode)) {
      write_in_place(file.text);
      return;
    }
    if (exists && ::access(path_.c_str(), W_OK) != 0) fail(path_, "written", errno);
    if (exists) target_ = std::filesystem::canonical(path_).string();  // of a link
    static std::atomic<unsigned> number{0};  // no other process or thread has this name
    for (;;) {
      name_ = fmt::format("{}.{}.{}.new", target_, ::getpid(), number++);
      Descriptor beside(name_, O_WRONLY | O_CREAT | O_EXCL);
      if (!beside.valid() && errno == EEXIST) continue;
      if (!beside.valid()) fail(path_, "written", errno);
      int error = beside.write(file.text);
      if (error == 0 && exists) error = beside.keep_mode(old.st_mode & 07777U);
      if (error == 0 && sync) error = beside.sync();
      const int closing = beside.close();
      if (error == 0) error = closing;
      if (error == 0) return;
      ::unlink(name_.c_str());
      fail(path_, "written", error);
    }
  }
  ~Beside() {
    if (!name_.empty()) ::unlink(name_.c_str());
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  void take_place() {
    if (name_.empty()) return;
    if (std::rename(name_.c_str(), target_.c_str()) != 0) fail(path_, "written", errno);
    name_.clear();
  }

 private:
  // E.g. /dev/stdout.
  void write_in_place(std::string_view text) const {
    Descriptor file(path_, O_WRONLY | O_TRUNC);
    if (!file.valid()) fail(path_, "written", errno);
    int error = file.write(text);
    const int closing = file.close();
    if (error == 0) error = closing;
    if (error != 0) fail(path_, "written", error);
  }

  std::string path_, target_;
  std::string name_;  // "" : it is in its place
};

}  // namespace

std::string read_text(const std::string& path) {
  using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
  const File file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) fail(path, "read", errno);
  std::string text;
  char block[1 << 14];
  for (std::size_t count; (count = std::fread(block, 1, sizeof block, file.get())) > 0;)
    text.append(block, count);
  if (std::ferror(file.get()) != 0) fail(path, "read", errno);
  return text;
}

void write_text(const std::string& path, std::string_view text) {
  Beside({path, std::string(text)}, false).take_place();
}

void write_together(std::span<const TextFile> files) {
  std::vector<std::unique_ptr<Beside>> whole;
  for (const TextFile& file : files) whole.push_back(std::make_unique<Beside>(file, true));
  for (const auto& file : whole) file->take_place();
}

}  // namespace grainlaw
