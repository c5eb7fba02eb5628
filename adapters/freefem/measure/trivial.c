/* A law that costs nothing, behind the functions of grainlaw.h that the plugin calls: loaded
 * before the library (LD_PRELOAD), it leaves the time of FreeFEM and of the plugin alone.
 * P = (F - I) Pa. */
#include <grainlaw/grainlaw.h>

static char material, set;
static size_t points;

grainlaw_status grainlaw_material_load(const char* path, grainlaw_material** out, char* message,
                                       size_t size) {
  (void)path, (void)message, (void)size;
  *out = (grainlaw_material*)&material;
  return GRAINLAW_OK;
}
int grainlaw_material_dimension(const grainlaw_material* handle) { return handle != NULL ? 2 : 0; }
void grainlaw_material_destroy(grainlaw_material* handle) { (void)handle; }

/* One set at a time. */
grainlaw_status grainlaw_points_create(const grainlaw_material* handle, size_t n,
                                       grainlaw_points** out) {
  (void)handle;
  points = n;
  *out = (grainlaw_points*)&set;
  return GRAINLAW_OK;
}
void grainlaw_points_destroy(grainlaw_points* handle) { (void)handle; }
size_t grainlaw_points_size(const grainlaw_points* handle) { return (void)handle, points; }
grainlaw_status grainlaw_points_commit(grainlaw_points* handle) {
  return (void)handle, GRAINLAW_OK;
}
grainlaw_status grainlaw_points_revert(grainlaw_points* handle) {
  return (void)handle, GRAINLAW_OK;
}
grainlaw_status grainlaw_points_set_time_step(grainlaw_points* handle, double step) {
  return (void)handle, (void)step, GRAINLAW_OK;
}

grainlaw_status grainlaw_points_evaluate(grainlaw_points* handle, const double* F, unsigned want,
                                         double* P, double* A, grainlaw_status* status,
                                         grainlaw_report* reports, int threads,
                                         grainlaw_summary* summary) {
  (void)handle, (void)want, (void)status, (void)reports, (void)threads, (void)summary;
  const size_t n = points;
  for (size_t k = 0; k < 4 * n; ++k) P[k] = F[k] - (k % 4 % 3 == 0);
  if (A != NULL)
    for (size_t k = 0; k < 16 * n; ++k) A[k] = k % 16 % 5 == 0;
  return GRAINLAW_OK;
}
