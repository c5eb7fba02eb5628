#include <grainlaw/grainlaw.h>
#include <stdio.h>

int main(void) {
  char message[512];
  grainlaw_material* sand;
  grainlaw_state* point; /* one per integration point */
  double F[4] = {1.0002, 0, 0, 0.999}, P[4], A[16];
  grainlaw_report report = grainlaw_report_default();

  if (grainlaw_material_load("sand.toml", &sand, message, sizeof message)) return puts(message), 1;
  if (grainlaw_state_create(sand, &point)) return 1;
  grainlaw_status status = grainlaw_evaluate(point, F, GRAINLAW_WANT_TANGENT_EXACT, P, A, &report);
  if (status > 0) printf("try %g of the step\n", report.step_ratio); /* nothing changed */
  if (status == 0) grainlaw_commit(point); /* once the load step of the host has converged */
  printf("P22 = %.1f kPa, dP22/dF22 = %.1f MPa\n", P[3] / 1e3, A[15] / 1e6);
  grainlaw_state_destroy(point);
  grainlaw_material_destroy(sand);
  return status;
}
