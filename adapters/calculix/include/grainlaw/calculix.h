/* grainlaw as a user material of CalculiX (2.20), through its native interface to external
 * behaviours: a solver built with CALCULIX_EXTERNAL_BEHAVIOURS_SUPPORT (Debian's is not;
 * adapters/calculix/build_solver makes one).
 *
 * A whole material library is
 *
 *     #include <grainlaw/calculix.h>
 *     GRAINLAW_CALCULIX_MATERIAL(SAND, "sand.toml")
 *
 *     cc -shared -fPIC sand.c -o libGRAIN.so -lgrainlaw_calculix
 *
 * and in the input, found through LD_LIBRARY_PATH and all in capitals,
 *
 *     *MATERIAL, NAME=@GRAIN_SAND
 *     *USER MATERIAL, CONSTANTS=1
 *     0.
 *     *STEP, NLGEOM
 *
 * A relative path starts at the folder of the library; the environment variable
 * GRAINLAW_MATERIAL_SAND, when set, goes before it, a relative one from the working directory in
 * which libgrainlaw_calculix was loaded. No *DEPVAR is needed.
 *
 * A packing of discs is plane strain: use CPE elements, or solid elements with all displacements
 * along 3 held. The stress is that of the packing from the start, so loads have to balance it
 * there.
 *
 * CalculiX takes dS/dE as symmetric; it gets the symmetric part of the exact tangent, and Newton
 * converges linearly once contacts slide.
 *
 * States are kept by element and point. CalculiX never says that an increment is accepted, and this
 * interface does not tell its number. It tells F at the start of the increment, which is
 * - the F of the committed state when the increment goes on or is tried again;
 * - the F of the last answer when that was accepted: this is the moment it is committed.
 */
#ifndef GRAINLAW_CALCULIX_H
#define GRAINLAW_CALCULIX_H

#include <stddef.h>

#include <grainlaw/grainlaw.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct grainlaw_calculix_material {
  const char* name;
  const char* material; /* path of the material file */
  void* points;         /* made by the first call */
} grainlaw_calculix_material;

/* One call of CalculiX. F0, F1[9]: deformation gradient at the start and the end of the increment,
 * column by column. dtime: its time, for solver.viscous_rate or solver.inertia (then in s).
 * stress_only: icmd is 3. stress[6]: second Piola-Kirchhoff stress 11 22 33 12 13 23 [Pa].
 * stiffness[21]: dS/dE, upper triangle column by column, of the symmetric part [Pa].
 * pnewdt: set to a number in 0..1 when the increment has to be cut; stress and stiffness are then
 * those of the start, the stiffness elastic, since CalculiX solves once more before it cuts. What
 * is wrong otherwise is printed as CalculiX prints its own errors, once, and asks for cuts too,
 * upon which CalculiX ends the analysis; states stay as committed. Any number of threads at once.
 */
GRAINLAW_API void grainlaw_calculix_evaluate(grainlaw_calculix_material*, int element, int point,
                                             const double* F0, const double* F1, double dtime,
                                             int stress_only, double* stress, double* stiffness,
                                             double* pnewdt);

/* Free all states; the next call starts anew. No other thread may be inside. */
GRAINLAW_API void grainlaw_calculix_release(grainlaw_calculix_material*);

#ifdef __cplusplus
}
#endif

/* The function that CalculiX calls for @LIBRARY_NAME; NAME in capitals. */
#define GRAINLAW_CALCULIX_MATERIAL(NAME, MATERIAL)                                                 \
  static grainlaw_calculix_material grainlaw_material_##NAME = {#NAME, MATERIAL, NULL};            \
  GRAINLAW_API void NAME(                                                                          \
      const char* amat, const int* iel, const int* iint, const int* nprops, const double* mprops,  \
      const double* stran1, const double* stran0, const double* beta, const double* F0,            \
      const double* voj, const double* F1, const double* vj, const int* ithermal,                  \
      const double* temp1, const double* dtime, const double* time, const double* ttime,           \
      const int* icmd, const int* ielas, const int* mi, const int* nstatv, const double* statev0,  \
      double* statev1, double* stress, double* ddsdde, const int* iorien, const double* pgauss,    \
      const double* orab, double* pnewdt, const int* ipkon, int size) {                            \
    (void)amat, (void)nprops, (void)mprops, (void)stran1, (void)stran0, (void)beta, (void)voj;     \
    (void)vj, (void)ithermal, (void)temp1, (void)time, (void)ttime, (void)ielas;                   \
    (void)mi, (void)nstatv, (void)statev0, (void)statev1, (void)iorien, (void)pgauss, (void)orab;  \
    (void)ipkon, (void)size;                                                                       \
    grainlaw_calculix_evaluate(&grainlaw_material_##NAME, *iel, *iint, F0, F1, *dtime, *icmd == 3, \
                               stress, ddsdde, pnewdt);                                            \
  }                                                                                                \
  __attribute__((destructor)) static void grainlaw_unload_##NAME(void) {                           \
    grainlaw_calculix_release(&grainlaw_material_##NAME);                                          \
  }

#endif
