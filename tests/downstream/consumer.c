/* A host in C99: load a material, compress it by 0.1 %, commit, print the stress. */
#include <grainlaw/grainlaw.h>
#include <stdio.h>

int main(int argc, char** argv) {
  const double F[4] = {1, 0, 0, 0.999};
  double P[4], A[16];
  char message[256];
  grainlaw_material* material = NULL;
  grainlaw_state* state = NULL;
  grainlaw_report report = grainlaw_report_default();
  grainlaw_status status;

  if (argc != 2) return 2;
  status = grainlaw_material_load(argv[1], &material, message, sizeof message);
  if (status != GRAINLAW_OK) {
    fprintf(stderr, "%s: %s\n", grainlaw_status_text(status), message);
    return 1;
  }
  status = grainlaw_state_create(material, &state);
  grainlaw_material_destroy(material); /* the state keeps what it needs */
  if (status == GRAINLAW_OK)
    status = grainlaw_evaluate(state, F, GRAINLAW_WANT_TANGENT_EXACT, P, A, &report);
  if (status == GRAINLAW_OK) status = grainlaw_commit(state);
  if (status == GRAINLAW_OK)
    printf("grainlaw %s: P11 = %.6g Pa, P22 = %.6g Pa, dP22/dF22 = %.6g Pa\n", grainlaw_version(),
           P[0], P[3], A[15]);
  else
    fprintf(stderr, "%s: %s\n", grainlaw_status_text(status), report.message);
  grainlaw_state_destroy(state);
  return status == GRAINLAW_OK ? 0 : 1;
}
