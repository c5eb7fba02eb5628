#include "io/text_file.hpp"

#include "base/error.hpp"
#include "io/descriptor.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

namespace grainlaw::core {

namespace {

std::string behind_links(const std::string& path) {
  const std::unique_ptr<char, void (*)(void*)> target(::realpath(path.c_str(), nullptr),
                                                      &std::free);
  if (target == nullptr) fail_file(path, "written", errno);
  return target.get();
}

// Turns a write beyond the file size limit into an error; SIGXFSZ would end the host.
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

// A temporary file in the directory of its target.
class Beside {
 public:
  Beside(const std::string& path, std::string_view text, const std::string& first, Writing writing)
      : path_(path), target_(path), writing_(writing) {
    struct stat old {};
    const bool exists = ::stat(path_.c_str(), &old) == 0;
    if (exists && !S_ISREG(old.st_mode)) {
      write_in_place(text);
      return;
    }
    if (exists && ::access(path_.c_str(), W_OK) != 0) fail_file(path_, "written", errno);
    struct stat name {};
    const bool link = exists && ::lstat(path_.c_str(), &name) == 0 && S_ISLNK(name.st_mode);
    if (link) target_ = behind_links(path_);
    const std::size_t end = target_.rfind('/');
    directory_ = end == std::string::npos ? "." : target_.substr(0, end + 1);
    static std::atomic<unsigned> number{0};
    const bool unique = first.empty() || link;  // behind a link may be another disk
    for (;;) {
      name_ = unique ? fmt::format("{}.{}.{}.new", target_, ::getpid(), number++) : first;
      Descriptor beside(name_, O_WRONLY | O_CREAT | (unique ? O_EXCL : O_TRUNC));
      if (!beside.valid() && errno == EEXIST && unique) continue;
      if (!beside.valid()) fail_file(path_, "written", errno);
      int error = beside.write(text);
      if (error == 0 && exists) error = beside.keep_mode(old.st_mode & 07777U);
      if (error == 0 && writing_.wait) error = beside.sync();
      const int closing = beside.close();
      if (error == 0) error = closing;
      if (error == 0) return;
      ::unlink(name_.c_str());
      fail_file(path_, "written", error);
    }
  }
  ~Beside() {
    if (!name_.empty()) ::unlink(name_.c_str());
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  void rename_to_target() {
    if (name_.empty()) return;
    if (std::rename(name_.c_str(), target_.c_str()) != 0) fail_file(path_, "written", errno);
    name_.clear();
    if (!writing_.wait) return;
    // The rename is durable once its directory is on disk; failures from here on are ignored.
    Descriptor directory(directory_, O_RDONLY | O_DIRECTORY);
    if (directory.valid()) static_cast<void>(directory.sync());
  }

 private:
  // Writes a target that is no regular file, e.g. /dev/stdout.
  void write_in_place(std::string_view text) const {
    Descriptor file(path_, O_WRONLY | O_TRUNC);
    if (!file.valid()) fail_file(path_, "written", errno);
    int error = file.write(text);
    const int closing = file.close();
    if (error == 0) error = closing;
    if (error != 0) fail_file(path_, "written", error);
  }

  std::string path_, target_, directory_;
  Writing writing_;
  std::string name_;  // "": renamed to its target
};

}  // namespace

std::string read_text(const std::string& path) {
  const Descriptor file(path, O_RDONLY);
  if (!file.valid()) fail_file(path, "read", errno);
  if (file.streams())
    throw Error(GRAINLAW_FILE_ERROR,
                fmt::format("{}: cannot be read: found a pipe or device, expected a file", path));
  std::string text;
  char block[1 << 14];
  ssize_t count = 0;
  while ((count = file.read(block, sizeof block)) > 0)
    text.append(block, static_cast<std::size_t>(count));
  if (count < 0) fail_file(path, "read", errno);
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
  return text;
}

void write_text(const std::string& path, std::string_view text, Writing writing) {
  const NoSizeSignal no_signal;
  Beside(path, text, {}, writing).rename_to_target();
}

void write_together(std::span<const TextFile> files, Writing writing) {
  const NoSizeSignal no_signal;
  std::vector<std::unique_ptr<Beside>> whole;
  for (const TextFile& file : files)
    whole.push_back(std::make_unique<Beside>(file.path, file.text, file.first, writing));
  for (const auto& file : whole) file->rename_to_target();
}

void sync_file(const std::string& path) {
  Descriptor file(path, O_RDONLY);
  if (!file.valid()) fail_file(path, "written", errno);
  if (const int error = file.sync(); error != 0) fail_file(path, "written", error);
}

GrowingFile::GrowingFile(const std::string& path)
    : path_(path), file_(path, O_WRONLY | O_CREAT | O_TRUNC) {
  if (!file_.valid()) fail_file(path, "written", errno);
}

GrowingFile::GrowingFile(const std::string& path, std::uintmax_t length)
    : path_(path), file_(path, O_WRONLY | O_APPEND), length_(length) {
  if (!file_.valid()) fail_file(path, "written", errno);
  if (const int error = file_.cut(length); error != 0) fail_file(path, "written", error);
}

void GrowingFile::append(std::string_view bytes) {
  const NoSizeSignal no_signal;
  if (const int error = file_.write(bytes); error != 0) {
    // Best effort: a reader would take a partial piece for a whole one.
    static_cast<void>(file_.cut(length_));
    fail_file(path_, "written", error);
  }
  length_ += bytes.size();
}

}  // namespace grainlaw::core
