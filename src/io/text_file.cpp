#include "io/text_file.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

namespace grainlaw {

namespace {

[[noreturn]] void fail(const std::string& path, const char* what, int error) {
  if (error == ENOMEM) throw std::bad_alloc();
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
  [[nodiscard]] ssize_t read(char* to, std::size_t size) const {
    for (;;) {
      const ssize_t count = ::read(number_, to, size);
      if (count >= 0 || errno != EINTR) return count;
    }
  }
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
  int sync() {
    const bool done = ::fsync(number_) == 0;
    return done || errno == EINVAL || errno == ENOSYS ? 0 : errno;  // some file systems cannot
  }
  int close() {
    const int result = number_ < 0 || ::close(number_) == 0 ? 0 : errno;
    number_ = -1;
    return result;
  }

 private:
  int number_;
};

std::string behind_links(const std::string& path) {
  const std::unique_ptr<char, void (*)(void*)> target(::realpath(path.c_str(), nullptr),
                                                      &std::free);
  if (target == nullptr) fail(path, "written", errno);
  return target.get();
}

// A write beyond the limit of file sizes is an error here, not the end of the host.
class NoSizeSignal {
 public:
  NoSizeSignal() {
    sigemptyset(&signal_);
    sigaddset(&signal_, SIGXFSZ);
    pthread_sigmask(SIG_BLOCK, &signal_, &before_);
  }
  ~NoSizeSignal() {
    sigset_t pending;
    if (sigismember(&before_, SIGXFSZ) == 0 && sigpending(&pending) == 0 &&
        sigismember(&pending, SIGXFSZ) == 1) {
      int taken;
      sigwait(&signal_, &taken);
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  NoSizeSignal(const NoSizeSignal&) = delete;
  NoSizeSignal& operator=(const NoSizeSignal&) = delete;

 private:
  sigset_t signal_, before_;
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
    if (exists) target_ = behind_links(path_);
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
  const Descriptor file(path, O_RDONLY);
  if (!file.valid()) fail(path, "read", errno);
  std::string text;
  char block[1 << 14];
  ssize_t count = 0;
  while ((count = file.read(block, sizeof block)) > 0)
    text.append(block, static_cast<std::size_t>(count));
  if (count < 0) fail(path, "read", errno);
  return text;
}

void write_text(const std::string& path, std::string_view text) {
  const NoSizeSignal no_signal;
  Beside({path, std::string(text)}, false).take_place();
}

void write_together(std::span<const TextFile> files) {
  const NoSizeSignal no_signal;
  std::vector<std::unique_ptr<Beside>> whole;
  for (const TextFile& file : files) whole.push_back(std::make_unique<Beside>(file, true));
  for (const auto& file : whole) file->take_place();
}

}  // namespace grainlaw
