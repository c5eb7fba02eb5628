#include "whole_file.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

namespace grainlaw::adapters {
namespace {

constexpr std::size_t buffer_size = 1 << 20;  // bytes

[[noreturn]] void fail(const std::string& path, int error) {
  throw std::runtime_error(path + ": cannot be written: " + std::strerror(error));
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

// Some file systems cannot be asked to.
bool synchronised(int descriptor) {
  return ::fsync(descriptor) == 0 || errno == EINVAL || errno == ENOSYS;
}

}  // namespace

WholeFile::WholeFile(const std::string& path) : path_(path) {
  std::error_code is_new;
  const auto behind_links = std::filesystem::canonical(path, is_new);
  target_ = is_new ? path : behind_links.string();
  struct stat old {};
  const bool exists = ::stat(target_.c_str(), &old) == 0;
  if (exists && ::access(target_.c_str(), W_OK) != 0) fail(path_, errno);
  buffer_.reserve(buffer_size);
  if (exists && !S_ISREG(old.st_mode)) {
    descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail(path_, errno);
    return;
  }
  for (int number = 0; descriptor_ < 0; ++number) {
    temporary_ = target_ + "." + std::to_string(::getpid()) + "-" + std::to_string(number) + ".new";
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) fail(path_, errno);
  }
  if (exists) static_cast<void>(::fchmod(descriptor_, old.st_mode & 07777));
}

WholeFile::~WholeFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void WholeFile::write(const void* bytes, std::size_t size) {
  if (buffer_.size() + size > buffer_size) flush();
  buffer_.append(static_cast<const char*>(bytes), size);
}

void WholeFile::flush() {
  const NoSizeSignal quiet;
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t count = ::write(descriptor_, rest.data(), rest.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path_, errno);
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
  buffer_.clear();
}

void WholeFile::close() {
  const int closing = std::exchange(descriptor_, -1);
  if (::close(closing) != 0) fail(path_, errno);
}

void WholeFile::keep() {
  flush();
  if (!synchronised(descriptor_)) fail(path_, errno);
  close();
  if (temporary_.empty()) return;
  const auto parent = std::filesystem::path(target_).parent_path();
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail(path_, errno);
  temporary_.clear();
  // The name itself is on the disk once its directory is; nothing fails any more.
  const int directory = ::open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_CLOEXEC);
  if (directory < 0) return;
  ::fsync(directory);
  ::close(directory);
}

}  // namespace grainlaw::adapters
