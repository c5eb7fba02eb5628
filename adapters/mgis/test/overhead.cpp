// What the MGIS adapter costs per point and call, with the packing taken out (idle_grainlaw.cpp):
// finding the state, deciding between retry and accepted, stress and tangent in the host's
// measures.
//
//   build/release/adapters/mgis/test/grainlaw_mgis_overhead
#include <grainlaw/mgis.h>

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

grainlaw_mgis_behaviour behaviour{"Idle", "/idle.toml", nullptr};

struct Cost {
  double first = 0, retry = 0, accepted = 0;  // ns per call
};

// Points in the order of a mesh, four calls of each in a step; the median of many steps.
Cost measure(int dimension, std::size_t points, int request, int stress, int tangent) {
  std::vector<double> gradients(9 * points), forces(9 * points), internal(2 * points);
  std::vector<double> internal1(2 * points), K(81 * points);
  for (std::size_t p = 0; p < points; ++p) std::fill_n(&gradients[9 * p], 3, 1.0);
  Cost cost;
  std::vector<double> retries, accepts;
  for (int step = 0; step < 50; ++step) {
    for (int call = 0; call < 4; ++call) {
      const double start = cpu_time();
      for (std::size_t p = 0; p < points; ++p) {
        double rdt = 1;
        grainlaw_mgis_data data{};
        data.K = &K[81 * p];
        data.K[0] = request;
        data.K[1] = stress;
        data.K[2] = tangent;
        data.rdt = &rdt;
        data.s0.gradients = data.s1.gradients = &gradients[9 * p];
        data.s1.thermodynamic_forces = &forces[9 * p];
        data.s0.internal_state_variables = &internal[2 * p];
        data.s1.internal_state_variables = &internal1[2 * p];
        if (grainlaw_mgis_integrate(&behaviour, dimension, &data) != 1) return {};
      }
      const double time = cpu_time() - start;
      const double each = time / static_cast<double>(points);
      if (step == 0 && call == 1) cost.first = each;
      if (step > 0) (call == 0 ? accepts : retries).push_back(each);
    }
    internal = internal1;
  }
  const auto median = [](std::vector<double>& all) {
    std::nth_element(all.begin(), all.begin() + static_cast<long>(all.size() / 2), all.end());
    return all[all.size() / 2];
  };
  cost.retry = median(retries);
  cost.accepted = median(accepts);
  grainlaw_mgis_release(&behaviour);
  return cost;
}

}  // namespace

int main() {
  struct Case {
    const char* name;
    int request, stress, tangent;
  };
  constexpr Case cases[] = {{"Cauchy, no tangent", 0, 0, 0},
                            {"Cauchy, dsigma/dF", 4, 0, 0},
                            {"PK2, dS/dE", 4, 1, 1},
                            {"PK1, dP/dF", 4, 2, 2},
                            {"Cauchy, dtau/d(dF)", 4, 0, 3}};
  std::printf("ns per point and call           points   retry  accepted  first increment\n");
  for (const int dimension : {2, 3}) {
    for (const std::size_t points : {std::size_t{100}, std::size_t{10000}}) {
      for (const Case& c : cases) {
        const Cost cost = measure(dimension, points, c.request, c.stress, c.tangent);
        std::printf("%-14s %-18s %5zu  %6.0f  %8.0f  %8.0f\n",
                    dimension == 2 ? "PlaneStrain" : "Tridimensional", c.name, points, cost.retry,
                    cost.accepted, cost.first);
      }
    }
  }
  return 0;
}
