/* For the tests in the solver: the material of the file named by GRAINLAW_MATERIAL_SAND. Every call
 * at the first point of the first element adds a line to the file GRAINLAW_RECORD. */
#include <grainlaw/calculix.h>

#include <stdio.h>
#include <stdlib.h>

static grainlaw_calculix_material material = {"SAND", "no_material_is_named.toml", NULL};

GRAINLAW_API void SAND(const char* amat, const int* iel, const int* iint, const int* nprops,
                       const double* mprops, const double* stran1, const double* stran0,
                       const double* beta, const double* F0, const double* voj, const double* F1,
                       const double* vj, const int* ithermal, const double* temp1,
                       const double* dtime, const double* time, const double* ttime,
                       const int* icmd, const int* ielas, const int* mi, const int* nstatv,
                       const double* statev0, double* statev1, double* stress, double* ddsdde,
                       const int* iorien, const double* pgauss, const double* orab, double* pnewdt,
                       const int* ipkon, int size) {
  const char* path = getenv("GRAINLAW_RECORD");
  FILE* record;
  int k;
  grainlaw_calculix_evaluate(&material, *iel, *iint, F0, F1, *dtime, *icmd == 3, stress, ddsdde,
                             pnewdt);
  if (path == NULL || *iel != 1 || *iint != 1) return;
  record = fopen(path, "a");
  if (record == NULL) return;
  fprintf(record, "%d,%d,%.17g,%.17g", *icmd, *ielas, *ttime + *time, *pnewdt);
  for (k = 0; k < 9; ++k) fprintf(record, ",%.17g", F1[k]);
  for (k = 0; k < 6; ++k) fprintf(record, ",%.17g", stress[k]);
  for (k = 0; k < 21; ++k) fprintf(record, ",%.17g", ddsdde[k]);
  fprintf(record, "\n");
  fclose(record);
  (void)amat, (void)nprops, (void)mprops, (void)stran1, (void)stran0, (void)beta, (void)voj;
  (void)vj, (void)ithermal, (void)temp1, (void)mi, (void)nstatv, (void)statev0, (void)statev1;
  (void)iorien, (void)pgauss, (void)orab, (void)ipkon, (void)size;
}
