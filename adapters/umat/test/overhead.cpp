// What UMAT costs per point and call, with the packing taken out (idle_grainlaw.cpp): finding the
// state, deciding between retry and accepted, Cauchy stress and DDSDDE.
//
//   build/release/adapters/umat/test/grainlaw_umat_overhead
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <vector>

// UMAT as a Fortran host calls it; the length of the name comes last.
extern "C" void umat_(double* stress, double* statev, double* ddsdde, double* sse, double* spd,
                      double* scd, double* rpl, double* ddsddt, double* drplde, double* drpldt,
                      double* stran, double* dstran, double* time, double* dtime, double* temp,
                      double* dtemp, double* predef, double* dpred, const char* cmname, int* ndi,
                      int* nshr, int* ntens, int* nstatv, double* props, int* nprops,
                      double* coords, double* drot, double* pnewdt, double* celent, double* dfgrd0,
                      double* dfgrd1, int* noel, int* npt, int* layer, int* kspt, int* kstep,
                      int* kinc, std::size_t length);

namespace {

// CPU time of this thread [ns]; other work on the machine does not count.
double cpu_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

void call(int element, int number, double* F0, double* F1, double* token) {
  char name[80];
  std::memset(name, ' ', sizeof name);
  std::memcpy(name, "IDLE", 4);
  double stress[4], ddsdde[16], unused[9] = {}, dtime = 1, pnewdt = 1;
  int direct = 3, shears = 1, size = 4, states = 1, zero = 0;
  umat_(stress, token, ddsdde, unused, unused, unused, unused, unused, unused, unused, unused,
        unused, unused, &dtime, unused, unused, unused, unused, name, &direct, &shears, &size,
        &states, unused, &zero, unused, unused, &pnewdt, unused, F0, F1, &element, &number, &zero,
        &zero, &zero, &zero, sizeof name);
  if (pnewdt < 1) std::printf("refused\n");
}

// Median over the sweeps of a mesh [ns per call]. Each increment moves F: the first call accepts the
// one before, the others are iterations.
void measure(int first, int points) {
  std::vector<double> iterations, accepted, tokens(static_cast<std::size_t>(points)), next(tokens);
  double F0[9]{1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (int increment = 1; increment < 50; ++increment) {
    double F1[9]{1, 0, 0, 0, 1, 0, 0, 0, 1};
    for (int iteration = 0; iteration < 3; ++iteration) {
      F1[3] = 1e-4 * increment + 1e-6 * iteration;
      const double start = cpu_time();
      for (int p = 0; p < points; ++p) {
        const auto k = static_cast<std::size_t>(p);
        next[k] = tokens[k];
        call(first + p / 8, 1 + p % 8, F0, F1, &next[k]);
      }
      (iteration == 0 ? accepted : iterations).push_back((cpu_time() - start) / points);
    }
    tokens = next;
    std::copy_n(F1, 9, F0);
  }
  const auto median = [](std::vector<double>& all) {
    std::nth_element(all.begin(), all.begin() + static_cast<long>(all.size() / 2), all.end());
    return all[all.size() / 2];
  };
  std::printf("%6d  %9.0f  %8.0f\n", points, median(iterations), median(accepted));
}

}  // namespace

int main() {
  std::printf("ns per point and call\npoints  iteration  accepted\n");
  measure(1, 104);
  measure(1000, 10000);
  return 0;
}
