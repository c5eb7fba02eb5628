#include "packing/text_file.hpp"

#include "error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <list>
#include <memory>
#include <new>
#include <string_view>
#include <utility>

namespace grainlaw {

namespace {

[[noreturn]] void fail(const std::string& path, const char* what) {
  const int error = errno;
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
  [[nodiscard]] bool write(std::string_view text) const {
    while (!text.empty()) {
      const ssize_t count = ::write(number_, text.data(), text.size());
      if (count < 0 && errno != EINTR) return false;
      if (count > 0) text.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
  }
  bool close() {
    const int number = std::exchange(number_, -1);
    return number < 0 || ::close(number) == 0;
  }

 private:
  int number_;
};

void write(const std::string& path, const TextFile& file) {
  Descriptor to(path, O_WRONLY | O_CREAT | O_TRUNC);
  if (!to.valid() || !to.write(file.text) || !to.close()) fail(file.path, "written");
}

// The new content of one file, gone unless it takes its place.
class Replacement {
 public:
  explicit Replacement(const TextFile& file) : file_(file), place_(file.path) {
    struct stat there;
    if (::stat(place_.c_str(), &there) == 0) {
      if (!S_ISREG(there.st_mode)) return;
      const std::unique_ptr<char, void (*)(void*)> target(::realpath(place_.c_str(), nullptr),
                                                          &std::free);
      if (target == nullptr || ::access(target.get(), W_OK) != 0) fail(place_, "written");
      place_ = target.get();  // of a link
    }
    beside_ = place_ + ".new";
    try {
      write(beside_, file);
    } catch (...) {
      remove();
      throw;
    }
  }
  ~Replacement() { remove(); }
  Replacement(const Replacement&) = delete;
  Replacement& operator=(const Replacement&) = delete;

  void take_place() {
    if (beside_.empty()) return write(place_, file_);
    if (std::rename(beside_.c_str(), place_.c_str()) != 0) fail(file_.path, "written");
    beside_.clear();
  }

 private:
  void remove() const {
    if (!beside_.empty()) ::unlink(beside_.c_str());
  }

  const TextFile& file_;
  std::string place_;
  std::string beside_;  // empty: written where it is
};

}  // namespace

std::string read_text(const std::string& path) {
  const Descriptor file(path, O_RDONLY);
  if (!file.valid()) fail(path, "read");
  std::string text;
  char block[1 << 14];
  ssize_t count = 0;
  while ((count = file.read(block, sizeof block)) > 0)
    text.append(block, static_cast<std::size_t>(count));
  if (count < 0) fail(path, "read");
  return text;
}

void write_texts(std::span<const TextFile> files) {
  std::list<Replacement> replacements;
  for (const TextFile& file : files) replacements.emplace_back(file);
  for (Replacement& replacement : replacements) replacement.take_place();
}

}  // namespace grainlaw
