/* A law that costs nothing, behind the functions of grainlaw.h that a load step calls: loaded before
 * the library (LD_PRELOAD), it leaves the time of FreeFEM and of the plugin alone. P = (F - I) Pa. */
#include <grainlaw/grainlaw.h>

grainlaw_status grainlaw_points_commit(grainlaw_points* handle) {
  return (void)handle, GRAINLAW_OK;
}
grainlaw_status grainlaw_points_revert(grainlaw_points* handle) {
  return (void)handle, GRAINLAW_OK;
}

/* The plugin evaluates all points, one after the other. */
grainlaw_status grainlaw_points_evaluate_some(grainlaw_points* handle, size_t n,
                                              const size_t* which, const double* F, size_t stride_F,
                                              unsigned want, double* P, size_t stride_P, double* A,
                                              size_t stride_A, grainlaw_status* status,
                                              grainlaw_report* reports, int threads,
                                              grainlaw_summary* summary) {
  (void)handle, (void)which, (void)stride_F, (void)want, (void)stride_P, (void)stride_A;
  (void)status, (void)reports, (void)threads, (void)summary;
  for (size_t k = 0; k < 4 * n; ++k) P[k] = F[k] - (k % 4 % 3 == 0);
  if (A != NULL)
    for (size_t k = 0; k < 16 * n; ++k) A[k] = k % 16 % 5 == 0;
  return GRAINLAW_OK;
}
