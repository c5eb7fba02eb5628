/* A law that costs nothing, behind the functions of grainlaw.h that the plugin calls: loaded
 * before the library (LD_PRELOAD), it leaves the time of FreeFEM and of the plugin alone.
 * P = (F - I) Pa. */
#include <grainlaw/grainlaw.h>

#include <string.h>

static char material, state;

grainlaw_status grainlaw_material_load(const char* path, grainlaw_material** out, char* message,
                                       size_t size) {
  (void)path, (void)message, (void)size;
  *out = (grainlaw_material*)&material;
  return GRAINLAW_OK;
}
int grainlaw_material_dimension(const grainlaw_material* handle) { return handle != NULL ? 2 : 0; }
void grainlaw_material_destroy(grainlaw_material* handle) { (void)handle; }

grainlaw_status grainlaw_state_create(const grainlaw_material* handle, grainlaw_state** out) {
  (void)handle;
  *out = (grainlaw_state*)&state;
  return GRAINLAW_OK;
}
void grainlaw_state_destroy(grainlaw_state* handle) { (void)handle; }
grainlaw_status grainlaw_commit(grainlaw_state* handle) { return (void)handle, GRAINLAW_OK; }
grainlaw_status grainlaw_revert(grainlaw_state* handle) { return (void)handle, GRAINLAW_OK; }

grainlaw_status grainlaw_evaluate_batch(size_t n, grainlaw_state* const* states, const double* F,
                                        unsigned want, double* P, double* A,
                                        grainlaw_status* status, grainlaw_report* reports,
                                        int threads) {
  (void)states, (void)want, (void)reports, (void)threads;
  memset(status, 0, n * sizeof *status);
  for (size_t k = 0; k < 4 * n; ++k) P[k] = F[k] - (k % 4 % 3 == 0);
  if (A != NULL)
    for (size_t k = 0; k < 16 * n; ++k) A[k] = k % 16 % 5 == 0;
  return GRAINLAW_OK;
}
