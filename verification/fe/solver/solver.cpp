#include "fe/solver/solver.hpp"

#include <algorithm>

namespace verification {

void run_load_steps(Solver& solver, double duration, int steps, int last,
                    const LoadObserver& observe, int first) {
  for (int step = first; step <= std::min(steps, last); ++step)
    observe(solver.advance(duration * step / steps, step), solver);
}

}  // namespace verification
