// What the CalculiX adapter costs per point and call, with the packing taken out
// (idle_grainlaw.cpp).
//
//   build/release/adapters/calculix/test/grainlaw_calculix_overhead
#include <grainlaw/calculix.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

namespace {

// CPU time of this thread [ns]; other work on the machine does not count.
double cpu_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

grainlaw_calculix_material material{"IDLE", "/idle.toml", nullptr};

// Median over the sweeps of a mesh [ns per call]. Each increment moves F: iterations at another F,
// the last word for the stress alone.
void measure(int points) {
  std::vector<double> iterations, accepted, last_words;
  double F0[9]{1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (int increment = 1; increment < 50; ++increment) {
    double F1[9]{1, 0, 0, 0, 1, 0, 0, 0, 1};
    for (int call = 0; call < 4; ++call) {
      if (call < 3) F1[3] = 1e-4 * increment + 1e-6 * call;
      const double start = cpu_time();
      for (int p = 0; p < points; ++p) {
        double stress[6], stiffness[21], pnewdt = -1;
        grainlaw_calculix_evaluate(&material, 1 + p / 8, 1 + p % 8, F0, F1, 1, call == 3, stress,
                                   stiffness, &pnewdt);
        if (pnewdt > 0) std::printf("refused\n");
      }
      const double time = cpu_time() - start;
      const double each = time / points;
      (call == 0 ? accepted : call == 3 ? last_words : iterations).push_back(each);
    }
    std::copy_n(F1, 9, F0);
  }
  const auto median = [](std::vector<double>& all) {
    std::nth_element(all.begin(), all.begin() + static_cast<long>(all.size() / 2), all.end());
    return all[all.size() / 2];
  };
  std::printf("%6d  %9.0f  %8.0f  %9.0f\n", points, median(iterations), median(accepted),
              median(last_words));
  grainlaw_calculix_release(&material);
}

}  // namespace

int main() {
  std::printf("ns per point and call\npoints  iteration  accepted  last word\n");
  measure(104);
  measure(10000);
  return 0;
}
