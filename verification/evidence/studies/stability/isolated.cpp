#include "evidence/studies/stability/isolated.hpp"

#include "app/library.hpp"

#include <fmt/format.h>

#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>

namespace verification::stability {
namespace {

constexpr double longest_wait = 20;  // wall time over CPU time, on a busy machine [-]

// Ends by SIGXCPU beyond so much CPU time [s].
[[noreturn]] void answer(const std::function<std::string()>& work, double seconds, int out) {
  rlimit limit{};
  if (getrlimit(RLIMIT_CPU, &limit) != 0) _exit(1);
  limit.rlim_cur = static_cast<rlim_t>(std::ceil(seconds));
  if (setrlimit(RLIMIT_CPU, &limit) != 0) _exit(1);
  const std::string text = work();
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = write(out, text.data() + done, text.size() - done);
    if (count <= 0) _exit(1);
    done += static_cast<std::size_t>(count);
  }
  _exit(0);
}

// Everything until the other end is closed; false when that takes too long.
bool read_all(int in, double seconds, std::string& text) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  std::array<char, 4096> buffer;
  while (true) {
    const auto left = std::chrono::duration<double, std::milli>(end - Clock::now()).count();
    pollfd ready{in, POLLIN, 0};
    if (left <= 0 || poll(&ready, 1, static_cast<int>(left) + 1) == 0) return false;
    const ssize_t count = read(in, buffer.data(), buffer.size());
    if (count <= 0) return true;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace

Answer run_isolated(const std::function<std::string()>& work, double seconds) {
  std::array<int, 2> ends{};
  std::fflush(nullptr);
  if (pipe(ends.data()) != 0) throw ComputationError("no pipe to a process of a case");
  const pid_t child = fork();
  if (child < 0) throw ComputationError("no process for a case");
  if (child == 0) {
    close(ends[0]);
    answer(work, seconds, ends[1]);
  }
  close(ends[1]);
  Answer result;
  const bool in_time = read_all(ends[0], longest_wait * seconds, result.text);
  close(ends[0]);
  if (!in_time) kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  if (!in_time)
    result.failure = fmt::format("no answer within {:g} s", longest_wait * seconds);
  else if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    result.failure = fmt::format("no answer within {:g} s of CPU time", seconds);
  else if (WIFSIGNALED(status))
    result.failure = fmt::format("the process ended by signal {} ({})", WTERMSIG(status),
                                 strsignal(WTERMSIG(status)));
  else if (status != 0)
    result.failure = "the process ended without an answer";
  return result;
}

}  // namespace verification::stability
