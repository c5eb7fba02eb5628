/* grainlaw: a constitutive law made of grains. This is the C ABI and the only header a host needs.
 * It includes points.h (sets of states), march.h (load steps that are cut), table.h (states by
 * element) and particles.h (particles and contacts).
 *
 * A finite element code owns one grainlaw_state per integration point. It passes a total
 * deformation gradient F, and receives the first Piola-Kirchhoff stress P and, on demand, the
 * tangent dP/dF. They belong to a granular representative volume (RVE) in equilibrium.
 *
 * Conventions, for every function below:
 *   - dim is grainlaw_material_dimension: 2 (discs) or 3 (spheres). Tensors are row-major:
 *     F[i*dim+J] = dx_i/dX_J.
 *   - SI units throughout. Stress in Pa, tension positive. A 2D packing has an out-of-plane
 *     thickness; it is plane strain with F33 = 1 and P33 = 0.
 *   - Every function that can fail returns a grainlaw_status. 0: done. > 0: recoverable, the
 *     committed state is unchanged, retry with a smaller step. < 0: caller error or internal fault,
 *     the committed state is unchanged.
 *   - No exception, exit, abort or print crosses this boundary, and no signal is raised.
 *   - A handle belongs to the copy of the library that made it. Another copy in the process refuses
 *     it (BAD_HANDLE).
 *   - A thread that is cancelled during a call (pthread_cancel, deferred) completes the call first.
 *   - After OUT_OF_MEMORY the call may be repeated, and its answer is unaffected.
 *   - A handle may be used by one thread at a time. Different states, also of one material, may be
 *     used by different threads simultaneously. Results do not depend on the number of threads, bit
 *     for bit. */
#ifndef GRAINLAW_GRAINLAW_H
#define GRAINLAW_GRAINLAW_H

#include <stddef.h>

#if defined(_WIN32)
#define GRAINLAW_API
#else
#define GRAINLAW_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define GRAINLAW_VERSION_MAJOR 0
#define GRAINLAW_VERSION_MINOR 1
#define GRAINLAW_VERSION_PATCH 0

/* Status codes and their texts: X(name, value, text). */
#define GRAINLAW_STATUS_LIST(X)                                                                    \
  X(GRAINLAW_OK, 0, "done")                                                                        \
  X(GRAINLAW_NOT_CONVERGED, 1, "no equilibrium was found for this step; retry with a smaller one") \
  X(GRAINLAW_CONTACTS_LOST, 2, "the packing lost its contacts; it carries no stress")              \
  X(GRAINLAW_INVERTED, 3, "det F <= 0; the element is inverted, retry with a smaller step")        \
  X(GRAINLAW_STEP_TOO_LARGE, 4, "F is too far from the committed one; retry with a smaller step")  \
  X(GRAINLAW_COLLAPSED, 5, "the packing no longer carries a uniform stress on its boundary")       \
  X(GRAINLAW_NULL_POINTER, -1, "a required pointer is null")                                       \
  X(GRAINLAW_BAD_HANDLE, -2, "the handle is not a live handle of this kind")                       \
  X(GRAINLAW_NOT_FINITE, -3, "F holds a NaN or an infinity")                                       \
  X(GRAINLAW_BAD_REPORT, -4, "the report has an unknown size; use grainlaw_report_default")        \
  X(GRAINLAW_BAD_ARGUMENT, -5, "an argument is outside its documented range")                      \
  X(GRAINLAW_NO_TRIAL, -6, "there is no evaluated trial state to commit")                          \
  X(GRAINLAW_FILE_ERROR, -7, "a file could not be read or written")                                \
  X(GRAINLAW_BAD_MATERIAL, -8, "the material description is wrong")                                \
  X(GRAINLAW_BAD_PACKING, -9, "the packing is wrong")                                              \
  X(GRAINLAW_BAD_BYTES, -10, "the saved state is damaged or truncated")                            \
  X(GRAINLAW_WRONG_VERSION, -11, "the saved state is of another format version")                   \
  X(GRAINLAW_WRONG_MATERIAL, -12, "the saved state belongs to another material")                   \
  X(GRAINLAW_BUFFER_TOO_SMALL, -13, "the caller's buffer is too small")                            \
  X(GRAINLAW_OUT_OF_MEMORY, -14, "out of memory")                                                  \
  X(GRAINLAW_INTERNAL_FAULT, -15, "internal fault; please report it")

/* An enum with int as underlying type: a host may pass any int, known or not. */
#ifdef __cplusplus
#define GRAINLAW_ENUM(name) enum name : int
#else
#define GRAINLAW_ENUM(name) enum name
#endif

typedef GRAINLAW_ENUM(grainlaw_status){
#define GRAINLAW_X(name, value, text) name = (value),
    GRAINLAW_STATUS_LIST(GRAINLAW_X)
#undef GRAINLAW_X
} grainlaw_status;

/* English text of a status; never null, also for an unknown value. */
GRAINLAW_API const char* grainlaw_status_text(grainlaw_status);

/* Version of the linked library, "major.minor.patch". */
GRAINLAW_API const char* grainlaw_version(void);

/* Immutable after creation; any number of states and threads share it. */
typedef struct grainlaw_material grainlaw_material;
/* One integration point: a committed state and a trial state. */
typedef struct grainlaw_state grainlaw_state;

/* ---- material ------------------------------------------------------------------------------- */

/* Read a material file (TOML; keys in docs/material.md) and the packing it names, and bring the
 * packing to equilibrium at F = I. Returns a new material in *out. Paths in the file are relative
 * to it. message (may be NULL) receives a zero-terminated text, truncated to message_size bytes. It
 * names file, line, key and expectation when something is wrong, and is "" on success. Errors:
 * NULL_POINTER, FILE_ERROR, BAD_MATERIAL, BAD_PACKING, NOT_CONVERGED (no equilibrium at F = I, or
 * under the prescribed stresses), CONTACTS_LOST (unless solver.contacts_lost = "stress_free"),
 * COLLAPSED, OUT_OF_MEMORY. On any error *out is NULL. */
GRAINLAW_API grainlaw_status grainlaw_material_load(const char* path, grainlaw_material** out,
                                                    char* message, size_t message_size);

/* grainlaw_material_load from text in memory. base_directory (NULL: the working directory) is the
 * base of relative paths, and replaces the file's name in messages. */
GRAINLAW_API grainlaw_status grainlaw_material_parse(const char* toml_text,
                                                     const char* base_directory,
                                                     grainlaw_material** out, char* message,
                                                     size_t message_size);

/* Keys that material files may have, in the order of reading, as zero-terminated text. A line for
 * each: its path, what is expected and its default, parted by tabs. text NULL: set *size to the
 * bytes needed. Otherwise *size is the capacity on entry, the bytes written on return. Errors:
 * NULL_POINTER, BUFFER_TOO_SMALL, OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_material_keys(char* text, size_t* size);

/* Write a material to bytes, with its packing in equilibrium: other ranks make the same material of
 * them without its files. bytes NULL: set *size to the required size. Otherwise *size is the capacity
 * on entry, the length on return. Errors: NULL_POINTER, BAD_HANDLE, BUFFER_TOO_SMALL,
 * OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_material_save(const grainlaw_material*, void* bytes,
                                                    size_t* size);

/* Make the material that was saved: its states give the same bits. A checksum tells damage; bytes of
 * unknown origin are not for this call. message as in grainlaw_material_load. Errors: NULL_POINTER,
 * BAD_BYTES, WRONG_VERSION, OUT_OF_MEMORY. On any error *out is NULL. */
GRAINLAW_API grainlaw_status grainlaw_material_load_saved(const void* bytes, size_t size,
                                                          grainlaw_material** out, char* message,
                                                          size_t message_size);

/* Compute a number that two materials share if their saved bytes are the same, as ranks compare it:
 * packing, law, boundary and solver. Errors: NULL_POINTER, BAD_HANDLE, OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_material_fingerprint(const grainlaw_material*,
                                                           unsigned long long* fingerprint);

/* Dimension 2 or 3; 0 for a null or dead handle. */
GRAINLAW_API int grainlaw_material_dimension(const grainlaw_material*);

/* Release the handle (NULL is allowed). States made from it stay valid. */
GRAINLAW_API void grainlaw_material_destroy(grainlaw_material*);

/* ---- state ---------------------------------------------------------------------------------- */

/* A new state at F = I, or at the F found for prescribed stresses, in equilibrium and without a
 * trial. Errors: NULL_POINTER, BAD_HANDLE, OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_state_create(const grainlaw_material*, grainlaw_state** out);

/* An independent copy, committed and trial. Errors: those of grainlaw_state_create. */
GRAINLAW_API grainlaw_status grainlaw_state_clone(const grainlaw_state*, grainlaw_state** out);

/* Release the handle (NULL is allowed). */
GRAINLAW_API void grainlaw_state_destroy(grainlaw_state*);

/* ---- evaluation ----------------------------------------------------------------------------- */

/* Bits of `want`. At most one may be set; 0: no tangent. */
enum {
  GRAINLAW_WANT_TANGENT_EXACT = 1,    /* derivative of P along the branch of equilibria */
  GRAINLAW_WANT_TANGENT_ELASTIC = 2,  /* affine estimate, Guo & Zhao (2014) eq. 9, as dP/dF: of all
                                         contacts that overlap, with the rotation of P */
  GRAINLAW_WANT_TANGENT_PERTURBED = 4 /* forward differences, Guo & Zhao (2014) eq. 8 */
};

/* Report of an evaluation. It starts with its own size and grows only at its end. */
typedef struct grainlaw_report {
  size_t size;            /* bytes of this struct in the caller's header */
  double residual;        /* max(|fx|, |fy|, |M|/R) over particles / mean contact normal force, or
                            solver.force_floor where that is larger [-] */
  double step_ratio;      /* suggested factor on the step, 1 after success; 0: a smaller step does
                             not help (status < 0) [-] */
  long relaxation_steps;  /* pseudo-time steps [-] */
  long servo_corrections; /* outer corrections of the servo method, 0 for direct [-] */
  int factorisations;     /* sparse factorisations, tangent included [-] */
  int subincrements;      /* parts of the increment, each from the equilibrium before it; 0: the
                             increment was not begun [-] */
  int contacts;           /* touching contacts [-] */
  int sliding;            /* contacts at the friction limit [-] */
  int status_changes;     /* contacts that opened, closed, stuck, slid or lost their bond [-] */
  int tangent_exact;      /* 1: the tangent is the derivative of the returned P */
  int history_advanced;   /* 1: a fallback advanced the friction history; approximate */
  char message[256];      /* one line of text, "" after plain success */
  int broken_bonds;       /* bonds that broke in this evaluation [-] */
  double unbalanced;      /* with solver.viscous_number: largest drag on a particle / mean contact
                             normal force, 0 at equilibrium; with solver.inertia: largest force of
                             inertia [-] */
  double viscous_work;    /* with solver.viscous_number: work done on the drag, of which its springs
                             and masses store a part; with solver.inertia: work of the contacts on
                             the fluctuations [J] */
  int rattlers_loaded;    /* particles that bear now and were left without a contact by an earlier
                             increment [-]. Rounding decides where such a particle is, and P with
                             it: P(Q F) differs from Q P(F). 0 with solver.viscous_number, and with
                             solver.inertia */
} grainlaw_report;

/* A report with its size set and zeros elsewhere. */
GRAINLAW_API grainlaw_report grainlaw_report_default(void);

/* Deform the committed RVE to the total deformation gradient F, find its equilibrium, and return:
 *   P[dim*dim]  first Piola-Kirchhoff stress, Pa, P[i*dim+J], tension positive (may be NULL);
 *   A[dim^4]    tangent dP_iJ/dF_kL, Pa, A[((i*dim+J)*dim+k)*dim+L] (may be NULL; needs a bit of
 *               want).
 * The result becomes the trial state. With solver.start = "committed" it depends on (committed
 * state, F) alone: same bits in every call.
 *
 * Tangent. Only an equilibrium has an exact tangent. With solver.loose_tolerance > 0 an increment
 * with alternating friction may end at that residual instead of solver.tolerance: see the report's
 * residual. A is then the tangent of the contacts as they stick, slide or are open. It is the
 * elastic tangent where the history was advanced, or where the former would be larger.
 * tangent_exact is then 0, and the message tells the kind. tangent_exact is also 0 for a sphere
 * with two contacts that rests against one without support.
 *
 * Errors: NULL_POINTER, BAD_HANDLE, NOT_FINITE, BAD_REPORT, BAD_ARGUMENT, OUT_OF_MEMORY.
 * Recoverable: NOT_CONVERGED, CONTACTS_LOST, INVERTED; STEP_TOO_LARGE (a stretch of more than
 * 30 %); COLLAPSED (a boundary under uniform stress with almost no force left, or with a particle
 * without contact). After any error P and A are untouched, and the committed state keeps its bits.
 * An F that is refused or fails also drops the trial, so that a host that ignores the failure
 * cannot commit an earlier one.
 *
 * Contacts lost. With solver.contacts_lost = "stress_free" an F at which no contact bears is not an
 * error. P and A are zero, tangent_exact is 1, contacts 0, the message says so, and the state may
 * be committed. Particles follow F, and bear again when they meet. At an F where they just touch A
 * is one of two derivatives, that of the free side. Forces that fade without an equilibrium count
 * as zero below solver.tolerance times the mean force at F = I (1e-6 of it at most).
 * history_advanced is 1 where particles separated in that way.
 *
 * Prescribed stresses (boundary "mixed"). The corresponding components of F are ignored and found
 * instead (measure DEFORMATION_GRADIENT). P returns the prescribed ones to the tolerance, and A has
 * zero rows and columns there.
 *
 * Rotations. P(Q F) = Q P(F), unless the boundary is bound to the axes of space like a test rig.
 * Such boundaries are sides with different rules in x and y, rigid rows, and prescribed stresses.
 * When packing, rules and stresses rotate too, P(Q F Q^T) = Q P(F) Q^T. */
GRAINLAW_API grainlaw_status grainlaw_evaluate(grainlaw_state*, const double* F, unsigned want,
                                               double* P, double* A, grainlaw_report* report);

/* n evaluations in `threads` threads including the caller's, the most expensive points first.
 * threads <= 0: OMP_NUM_THREADS of the environment if set, else the number of processors of this
 * process. The library's own threads persist for the next batch. Where some cannot be started, e.g.
 * under a limit, fewer do all the work, at worst the caller alone. A child of fork starts its own.
 * F[n*dim*dim], P[n*dim*dim] or NULL, A[n*dim^4] or NULL, status[n], reports[n] or NULL. All states
 * must be distinct and of one dimension. Returns OK when all points are OK, else the status of the
 * first failed point, fatal before recoverable. */
GRAINLAW_API grainlaw_status grainlaw_evaluate_batch(size_t n, grainlaw_state* const* states,
                                                     const double* F, unsigned want, double* P,
                                                     double* A, grainlaw_status* status,
                                                     grainlaw_report* reports, int threads);

/* Set the time of the following increments, in the unit of solver.viscous_rate, with solver.inertia
 * in s; copies and bytes keep it. A material with one of these keys asks for it: without one, or
 * with 0, F has to stay (BAD_ARGUMENT). To others the strain is the time, and they ignore it. Errors: NULL_POINTER,
 * BAD_HANDLE, BAD_ARGUMENT (not finite, or below 0). */
GRAINLAW_API grainlaw_status grainlaw_state_set_time_step(grainlaw_state*, double time_step);

/* Make the trial the committed state. Errors: NULL_POINTER, BAD_HANDLE, NO_TRIAL. */
GRAINLAW_API grainlaw_status grainlaw_commit(grainlaw_state*);

/* Drop the trial, if any. Errors: NULL_POINTER, BAD_HANDLE. */
GRAINLAW_API grainlaw_status grainlaw_revert(grainlaw_state*);

/* ---- save and load -------------------------------------------------------------------------- */

/* Write the committed state to bytes. bytes NULL: set *size to the required size. Otherwise *size
 * is the capacity on entry, the length on return. Errors: NULL_POINTER, BAD_HANDLE,
 * BUFFER_TOO_SMALL. */
GRAINLAW_API grainlaw_status grainlaw_state_save(const grainlaw_state*, void* bytes, size_t* size);

/* Replace the committed state by saved bytes and drop the trial. Bytes have a version and a
 * checksum. Damaged bytes, and those of another version or material, are refused, and nothing
 * changes. Prescribed stresses are a load: a material that differs in them alone is accepted.
 * Errors: NULL_POINTER, BAD_HANDLE, BAD_BYTES, WRONG_VERSION, WRONG_MATERIAL, OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_state_load(grainlaw_state*, const void* bytes, size_t size);

/* ---- measures and output -------------------------------------------------------------------- */

/* Measures of the trial state, or of the committed one without a trial: X(name, value, count,
 * text). A count of -2 means dim*dim, -1 the number of rotation components (1 in 2D).
 * ANISOTROPY is infinite when all contacts are parallel, and 0 without any.
 * DISSIPATED_ENERGY sums the losses from one committed state to the next. These are losses of
 * sliding and rolling contacts and of springs that unload, and all losses of contacts at the F
 * where bonds break. A packing that snaps between two equilibria without sliding loses energy that
 * is not included (with friction 0 the measure stays 0). After an increment with
 * report.history_advanced = 1 it also includes alternating sliding of the relaxation. */
#define GRAINLAW_MEASURE_LIST(X)                                                                  \
  X(GRAINLAW_CAUCHY_STRESS, 0, -2, "Cauchy stress P F^T / det F [Pa], tension positive")          \
  X(GRAINLAW_VOLUME, 1, 1, "current volume [m3]")                                                 \
  X(GRAINLAW_VOID_RATIO, 2, 1, "volume of voids / volume of particles [-]")                       \
  X(GRAINLAW_COORDINATION, 3, 1, "2 C / N over all particles [-]")                                \
  X(GRAINLAW_COORDINATION_NO_RATTLERS, 4, 1, "(2 C - N1)/(N - N0 - N1), N_k with k contacts [-]") \
  X(GRAINLAW_FABRIC, 5, -2, "fabric tensor (1/C) sum n n, Guo & Zhao eq. 22 [-]")                 \
  X(GRAINLAW_ANISOTROPY, 6, 1, "largest / smallest fabric eigenvalue - 1, Liu et al. eq. 38 [-]") \
  X(GRAINLAW_FABRIC_INTENSITY, 7, 1, "F_a, second invariant of 4 dev fabric, eqs. 24-25 [-]")     \
  X(GRAINLAW_MEAN_OVERLAP, 8, 1, "mean overlap of touching contacts [m]")                         \
  X(GRAINLAW_MEAN_ROTATION, 9, -1, "mean particle rotation since F = I [rad]")                    \
  X(GRAINLAW_ELASTIC_ENERGY, 10, 1, "energy stored in the contacts [J]")                          \
  X(GRAINLAW_DISSIPATED_ENERGY, 11, 1, "by friction, rolling, broken bonds since F = I [J]")      \
  X(GRAINLAW_BROKEN_BONDS, 12, 1, "bonds broken since F = I, copies on a frame once [-]")         \
  X(GRAINLAW_CONTACTS, 13, 1, "number of touching contacts [-]")                                  \
  X(GRAINLAW_PARTICLES, 14, 1, "number of particles, images of a frame counted once [-]")         \
  X(GRAINLAW_REFERENCE_VOLUME, 15, 1, "volume at F = I [m3]")                                     \
  X(GRAINLAW_DEFORMATION_GRADIENT, 16, -2, "F of this state, found components included [-]")      \
  X(GRAINLAW_ESCAPED_PARTICLES, 17, 1, "inner particles outside the polygon of the frame [-]")    \
  X(GRAINLAW_KINETIC_ENERGY, 18, 1, "of the fluctuations, with solver.inertia [J]")

typedef GRAINLAW_ENUM(grainlaw_measure){
#define GRAINLAW_X(name, value, count, text) name = (value),
    GRAINLAW_MEASURE_LIST(GRAINLAW_X)
#undef GRAINLAW_X
} grainlaw_measure;

/* Compute a measure. value NULL: set *count to the number of components. Otherwise *count is the
 * capacity on entry, the number written on return. Errors: NULL_POINTER, BAD_HANDLE, BAD_ARGUMENT
 * (unknown measure), BUFFER_TOO_SMALL. */
GRAINLAW_API grainlaw_status grainlaw_state_measure(const grainlaw_state*, grainlaw_measure what,
                                                    double* value, size_t* count);

/* Write particles (radius, rotation) and force chains (normal and tangential force, moment, bonded)
 * as one VTK PolyData file (.vtp) for ParaView. They are those of the trial state, or of the
 * committed one without a trial. An existing file is replaced once the new one is complete, and
 * stays when writing fails. Errors: NULL_POINTER, BAD_HANDLE, FILE_ERROR, OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_state_write_vtk(const grainlaw_state*, const char* path);

/* Write the trial state, or the committed one without a trial, as a packing. The files are
 * prefix_particles.csv, prefix_contacts.csv (with forces, moments and bonds) and prefix_cell.csv. A
 * material file with the same contacts and boundary reads them back to the same equilibrium: its P
 * at F = I is the present P F^T / det F. A deformed frame adds reference_x, reference_y and F00 to
 * F11, the reference of its conditions. All three files are complete and on disk before the first
 * replaces an existing one. Errors: NULL_POINTER, BAD_HANDLE, FILE_ERROR, OUT_OF_MEMORY,
 * BAD_PACKING (the packing could not be read back; nothing is written). */
GRAINLAW_API grainlaw_status grainlaw_state_write_packing(const grainlaw_state*,
                                                          const char* prefix);

#ifdef __cplusplus
}
#endif

#include <grainlaw/march.h>
#include <grainlaw/particles.h>
#include <grainlaw/points.h>
#include <grainlaw/table.h>

#endif
