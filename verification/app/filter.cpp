#include "app/filter.hpp"

#include "app/library.hpp"
#include "app/progress.hpp"
#include "app/text.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <string_view>

namespace verification {
namespace {

// A file in memory alone: a picture gets its name when it is whole.
class MemoryFile {
 public:
  explicit MemoryFile(const char* name) : number_(::memfd_create(name, MFD_CLOEXEC)) {
    if (number_ < 0) fail();
  }
  ~MemoryFile() { ::close(number_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] int number() const { return number_; }
  void write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = ::write(number_, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail();
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    ::lseek(number_, 0, SEEK_SET);
  }
  [[nodiscard]] std::string read() const {
    std::string bytes;
    char block[1 << 14];
    ::lseek(number_, 0, SEEK_SET);
    for (ssize_t count; (count = ::read(number_, block, sizeof block)) > 0;)
      bytes.append(block, static_cast<std::size_t>(count));
    return bytes;
  }

 private:
  [[noreturn]] static void fail() {
    throw ComputationError(fmt::format("a picture in memory: {}", std::strerror(errno)));
  }

  int number_;
};

// Spawn attributes: a process group of its own, so that Ctrl-C does not stop a picture, and default
// signals.
class Attributes {
 public:
  Attributes() {
    posix_spawnattr_init(&attributes_);
    sigset_t usual;
    sigemptyset(&usual);
    posix_spawnattr_setsigmask(&attributes_, &usual);
    for (const int number : {SIGPIPE, SIGXFSZ}) sigaddset(&usual, number);
    posix_spawnattr_setsigdefault(&attributes_, &usual);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(
        &attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  }
  ~Attributes() { posix_spawnattr_destroy(&attributes_); }
  Attributes(const Attributes&) = delete;
  Attributes& operator=(const Attributes&) = delete;
  [[nodiscard]] const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_{};
};

}  // namespace

std::optional<std::string> filter(std::vector<std::string> command, const char* package,
                                  const std::string& text, const std::filesystem::path& picture) {
  const MemoryFile input("text"), output("picture");
  input.write(text);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, input.number(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, output.number(), STDOUT_FILENO);
  std::vector<char*> arguments;
  for (std::string& argument : command) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  const std::string& program = command.front();
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, program.c_str(), &files, Attributes().get(),
                                   arguments.data(), ::environ);
  posix_spawn_file_actions_destroy(&files);
  const auto none = [&](const std::string& why) {
    tell(terminal_text(fmt::format("no picture {}: {} {}\n", picture.string(), program, why)));
    return std::nullopt;
  };
  if (error == ENOENT) return none(fmt::format("was not found (Debian package {})", package));
  if (error != 0) return none(fmt::format("does not start: {}", std::strerror(error)));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  std::string result = output.read();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || result.empty()) return none("failed");
  return result;
}

}  // namespace verification
