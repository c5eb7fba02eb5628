// Time of a finite element run by stages.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <ctime>

namespace verification {

enum class Stage { points, assembly, linear_solve, output };
inline constexpr std::size_t stages = 4;

// Processor time of all threads, waiting ones included, and elapsed time [s].
struct Spent {
  double cpu = 0;
  double elapsed = 0;

  static Spent now() {
    const auto time = std::chrono::steady_clock::now().time_since_epoch();
    return {static_cast<double>(std::clock()) / CLOCKS_PER_SEC,
            std::chrono::duration<double>(time).count()};
  }
  Spent operator-(const Spent& other) const { return {cpu - other.cpu, elapsed - other.elapsed}; }
  Spent& operator+=(const Spent& other) {
    cpu += other.cpu;
    elapsed += other.elapsed;
    return *this;
  }
};

// Sum of the time in each stage; the rest belongs to none.
class Cost {
 public:
  class Measure {
   public:
    explicit Measure(Spent& sum) : sum_(sum) {}
    ~Measure() { sum_ += Spent::now() - start_; }
    Measure(const Measure&) = delete;
    Measure& operator=(const Measure&) = delete;

   private:
    Spent& sum_;
    Spent start_ = Spent::now();
  };

  // Measures until the end of the block: `const auto measure = cost.measure(Stage::points);`
  [[nodiscard]] Measure measure(Stage stage) {
    return Measure(spent_[static_cast<std::size_t>(stage)]);
  }
  [[nodiscard]] const Spent& of(Stage stage) const {
    return spent_[static_cast<std::size_t>(stage)];
  }

 private:
  std::array<Spent, stages> spent_;
};

}  // namespace verification
