#include "app/gnuplot.hpp"

#include "app/atomic_file.hpp"
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
#include <initializer_list>
#include <optional>

namespace verification {
namespace {

// A file in memory: a picture is written once it is complete.
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

struct Answer {
  int error = 0;  // of starting the process
  bool done = false;
  std::string output;
};

// Runs gnuplot without a shell, gnuplotrc and ~/.gnuplot.
Answer answer_of_gnuplot(const std::string& script) {
  const MemoryFile input("script"), output("picture");
  input.write(script);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, input.number(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, output.number(), STDOUT_FILENO);
  char program[] = "gnuplot", defaults[] = "-d";
  char* const arguments[] = {program, defaults, nullptr};
  Answer answer;
  pid_t child = 0;
  answer.error = ::posix_spawnp(&child, program, &files, Attributes().get(), arguments, ::environ);
  posix_spawn_file_actions_destroy(&files);
  if (answer.error != 0) return answer;
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  answer.done = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  answer.output = output.read();
  return answer;
}

// Mends XML: gnuplot escapes only & and <, but "]]>" and most control characters are not allowed.
std::string well_formed(const std::string& svg) {
  std::string result;
  for (const char c : svg) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '>' && result.ends_with("]]"))
      result += "&gt;";
    else if (code < 0x20 && c != '\t' && c != '\n' && c != '\r')
      result += "\xEF\xBF\xBD";
    else
      result += c;
  }
  return result;
}

}  // namespace

bool run_gnuplot(const std::string& body, const std::filesystem::path& stem, int width,
                 int height) {
  const std::string text = terminal_text(body);  // bytes outside UTF-8 as \xff
  for (const std::string kind : {"svg", "png"}) {
    const Answer answer = answer_of_gnuplot(
        fmt::format("set encoding utf8\nset terminal {} size {},{} font 'DejaVu Sans,14' "
                    "background '#ffffff'\n{}",
                    kind == "svg" ? "svg" : "pngcairo", width, height, text));
    if (!answer.done || answer.output.empty()) {
      tell(terminal_text(
          fmt::format("no picture {}: {}\n", stem.string(),
                      answer.error == ENOENT ? "gnuplot was not found (Debian package gnuplot-nox)"
                      : answer.error != 0
                          ? fmt::format("gnuplot does not start: {}", std::strerror(answer.error))
                          : "gnuplot failed")));
      return false;
    }
    write_file(stem.string() + "." + kind,
               kind == "svg" ? well_formed(answer.output) : answer.output);
  }
  return true;
}

}  // namespace verification
