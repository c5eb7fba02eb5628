// Progress of a long run, one line on stderr.
#pragma once

#include <chrono>
#include <string>

namespace verification {

// Writes to stderr; failures are ignored.
void tell(const std::string& text);

// Progress line: rewritten in place on a terminal, else printed every few seconds.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Shows the completed fraction, 0..1, and a short text. The time left assumes the mean speed
  // since the first call.
  void update(double fraction, const std::string& text);
  // Removes the line from the terminal; call it before other output.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool terminal_;
  bool shown_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
  Clock::time_point first_ = start_;
  double first_fraction_ = -1;
};

}  // namespace verification
