/* Sets of points: operations of a finite element code on all of its states. Included by grainlaw.h,
 * whose conventions hold here too.
 *
 * A set contains integration points, numbered from 0, of one material; grainlaw_points_resize adds
 * points of another. After a converged load step, or after an evaluation of the set that returned
 * > 0:
 *   grainlaw_points_commit(set);
 *   grainlaw_points_revert(set);   and retry with a step smaller by summary.step_ratio */
#ifndef GRAINLAW_POINTS_H
#define GRAINLAW_POINTS_H

#include <grainlaw/grainlaw.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Many states of one dimension. */
typedef struct grainlaw_points grainlaw_points;

/* A set of n states as from grainlaw_state_create; n may be 0, e.g. on a rank without elements.
 * Errors: NULL_POINTER, BAD_HANDLE, OUT_OF_MEMORY. On any error *out is NULL. */
GRAINLAW_API grainlaw_status grainlaw_points_create(const grainlaw_material*, size_t n,
                                                    grainlaw_points** out);

/* An independent copy, committed and trial. Errors: those of grainlaw_points_create. */
GRAINLAW_API grainlaw_status grainlaw_points_clone(const grainlaw_points*, grainlaw_points** out);

/* Release the handle (NULL is allowed) and its states. */
GRAINLAW_API void grainlaw_points_destroy(grainlaw_points*);

/* Number of points; 0 for a null or dead handle. */
GRAINLAW_API size_t grainlaw_points_size(const grainlaw_points*);

/* The state of one point, for measures, bytes, copies and files. NULL for a number outside the set,
 * and for a null or dead handle. The set owns it, and the pointer never changes during the set's
 * life. Functions that would change or destroy it refuse it (BAD_HANDLE). */
GRAINLAW_API const grainlaw_state* grainlaw_points_state(const grainlaw_points*, size_t point);

/* Summary of an evaluation of a set. It starts with its own size and grows only at its end. */
typedef struct grainlaw_summary {
  size_t size;       /* bytes of this struct in the caller's header */
  double step_ratio; /* smallest step ratio of the failed points, 1 without any; 0: a smaller step
                        does not help [-] */
  long failed;       /* points whose status is not OK [-] */
  long first_failed; /* number of the first, fatal before recoverable; -1: none */
  char message[256]; /* of that point, or the reason of a refused call; "" after success */
  int rank; /* whose point that is, in a set that is shared by ranks; -1: none, or unshared */
} grainlaw_summary;

/* A summary without failures: its size set, step_ratio 1, first_failed and rank -1, zeros elsewhere.
 */
GRAINLAW_API grainlaw_summary grainlaw_summary_default(void);

/* grainlaw_evaluate for all points of a set, in threads as in grainlaw_evaluate_batch.
 * F[n*dim*dim], P[n*dim*dim] or NULL, A[n*dim^4] or NULL, status[n] or NULL, reports[n] or NULL,
 * summary or NULL. Returns OK when all points are OK, else the status of the first failed point,
 * fatal before recoverable. P and A of failed points are untouched, those of other points are
 * written. A set with a failed point cannot be committed. Refused before any evaluation, with all
 * statuses equal to the returned one and summary.failed = 0: NULL_POINTER, BAD_ARGUMENT, BAD_REPORT
 * of a report. Refused without writing anything: BAD_HANDLE, BAD_REPORT of the summary. Only points
 * allocate memory. */
GRAINLAW_API grainlaw_status grainlaw_points_evaluate(grainlaw_points*, const double* F,
                                                      unsigned want, double* P, double* A,
                                                      grainlaw_status* status,
                                                      grainlaw_report* reports, int threads,
                                                      grainlaw_summary* summary);

/* grainlaw_state_set_time_step for all points. */
GRAINLAW_API grainlaw_status grainlaw_points_set_time_step(grainlaw_points*, double time_step);

/* Make all trials the committed states; none changes where one point has no trial. Errors:
 * NULL_POINTER, BAD_HANDLE, NO_TRIAL. */
GRAINLAW_API grainlaw_status grainlaw_points_commit(grainlaw_points*);

/* Drop the trials, if any. Errors: NULL_POINTER, BAD_HANDLE. */
GRAINLAW_API grainlaw_status grainlaw_points_revert(grainlaw_points*);

/* Write the committed states of all points to bytes: each as by grainlaw_points_save_some, with a
 * version and a checksum of the whole. bytes NULL: set *size to the required size. Otherwise *size is the
 * capacity on entry, the length on return. Errors: NULL_POINTER, BAD_HANDLE, BUFFER_TOO_SMALL. */
GRAINLAW_API grainlaw_status grainlaw_points_save(const grainlaw_points*, void* bytes,
                                                  size_t* size);

/* Replace the committed states of all points by saved bytes and drop the trials. A set of one takes
 * those of grainlaw_state_save too. Bytes that grainlaw_state_load refuses, and those of a set of
 * another size, are refused, and nothing changes. message (may be NULL) receives a zero-terminated
 * text that names the point and the fault, truncated to message_size bytes; it is "" on success.
 * Errors: NULL_POINTER, BAD_HANDLE, BAD_BYTES, WRONG_VERSION, WRONG_MATERIAL, BAD_ARGUMENT (another
 * number of points), OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_points_load(grainlaw_points*, const void* bytes, size_t size,
                                                  char* message, size_t message_size);

/* Compute a measure of all points, values[n * components], by points, each as from
 * grainlaw_state_measure. values NULL: set *count to n * components. Otherwise *count is the
 * capacity on entry, the number written on return. On any error nothing is written. Errors:
 * NULL_POINTER, BAD_HANDLE, BAD_ARGUMENT (unknown measure), BUFFER_TOO_SMALL, OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_points_measure(const grainlaw_points*, grainlaw_measure what,
                                                     double* values, size_t* count);

/* Write P and A of the committed states, without an increment: P[n*dim*dim] or NULL, A[n*dim^4] or
 * NULL (needs a bit of want). P has the bits of the evaluation that was committed. A has them too,
 * where that evaluation was asked for the same tangent; bytes of the set keep it. Elsewhere, e.g. at
 * F = I, A is that of a copy evaluated at the committed F, in no time. No state changes. threads,
 * summary and the returned status are those of grainlaw_points_evaluate. */
GRAINLAW_API grainlaw_status grainlaw_points_answer(grainlaw_points*, unsigned want, double* P,
                                                    double* A, int threads,
                                                    grainlaw_summary* summary);

/* Write the processor time that the last evaluation of each point took, seconds[n] [s]; 0 before
 * any. Copies keep it, bytes do not. Errors: NULL_POINTER, BAD_HANDLE. */
GRAINLAW_API grainlaw_status grainlaw_points_cost(const grainlaw_points*, double* seconds);

/* ---- points by number ----------------------------------------------------------------------- */

/* Below, which[n] are numbers of points, NULL: 0 to n - 1; n may be 0. Numbers outside the set are
 * refused (BAD_ARGUMENT), and so is a number that comes twice where its point would change. */

/* grainlaw_points_evaluate for some points. Of point which[k] are F + k * F_stride, P + k * P_stride,
 * A + k * A_stride, status[k] and reports[k]. Strides count doubles; 0: without gaps, dim*dim and
 * dim^4. Points that are not asked for keep their trials. Refused as there; BAD_ARGUMENT also for
 * wrong numbers, and a stride shorter than its tensor. */
GRAINLAW_API grainlaw_status grainlaw_points_evaluate_some(
    grainlaw_points*, size_t n, const size_t* which, const double* F, size_t F_stride,
    unsigned want, double* P, size_t P_stride, double* A, size_t A_stride, grainlaw_status* status,
    grainlaw_report* reports, int threads, grainlaw_summary* summary);

/* Write the committed states of some points: which[k] from offsets[k] to offsets[k + 1] of bytes.
 * They are those of grainlaw_state_save, followed by the tangent where one was committed;
 * grainlaw_state_load takes them. bytes NULL: set offsets[n + 1], from 0 on. Otherwise bytes has
 * room for offsets[n], and offsets are as they were set. Errors, upon which nothing is written:
 * NULL_POINTER, BAD_HANDLE, BAD_ARGUMENT, BUFFER_TOO_SMALL (a state needs another number of bytes
 * than offsets say). */
GRAINLAW_API grainlaw_status grainlaw_points_save_some(const grainlaw_points*, size_t n,
                                                       const size_t* which, void* bytes,
                                                       size_t* offsets);

/* Replace the committed states of some points by saved ones, all or none, and drop their trials.
 * offsets[n + 1] as of grainlaw_points_save_some, in any order; those of grainlaw_state_save are
 * taken too. message as in grainlaw_points_load. Errors: NULL_POINTER, BAD_HANDLE, BAD_ARGUMENT,
 * BAD_BYTES, WRONG_VERSION, WRONG_MATERIAL, OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_points_load_some(grainlaw_points*, size_t n,
                                                       const size_t* which, const void* bytes,
                                                       const size_t* offsets, char* message,
                                                       size_t message_size);

/* Change the number of points. Points from n on are released, with the pointers to their states. New
 * ones are as from grainlaw_state_create, of `material`; NULL: of the set's first material. Errors,
 * upon which nothing changes: NULL_POINTER, BAD_HANDLE, BAD_ARGUMENT (a material of the other
 * dimension), OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_points_resize(grainlaw_points*, size_t n,
                                                    const grainlaw_material* material);

/* Make point which_to[k] of `to` an independent copy of which_from[k] of `from`, committed and trial,
 * with its material; all or none. Both sets may be one: the copies are of the points before the
 * call. Errors: NULL_POINTER, BAD_HANDLE, BAD_ARGUMENT (also sets of two dimensions),
 * OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_points_clone_some(grainlaw_points* to, size_t n,
                                                        const size_t* which_to,
                                                        const grainlaw_points* from,
                                                        const size_t* which_from);

/* ---- initial stress ------------------------------------------------------------------------- */

typedef GRAINLAW_ENUM(grainlaw_route){
    GRAINLAW_PROPORTIONAL = 0, /* all components together, from the present stress */
    GRAINLAW_ISOTROPIC = 1,    /* to the mean pressure with equal principal stresses, then on */
    GRAINLAW_K0 = 2 /* the traction on the plane across `axis`, without strain within it */
} grainlaw_route;

/* How points are led to a stress. It starts with its own size and grows only at its end. */
typedef struct grainlaw_consolidation {
  size_t size;           /* bytes of this struct in the caller's header */
  grainlaw_route route;  /* by which the stress is led */
  double axis[3];        /* of K0: across the plane, e.g. against gravity; 0: the last axis [-] */
  double first_pressure; /* isotropic pressure to lead to before; 0: none [Pa] */
  double overconsolidation; /* stress of the past over the one asked for, at least 1 [-] */
  double largest_step;      /* change of the stress in one increment over its norm [-] */
} grainlaw_consolidation;

/* Proportional, from the present stress, overconsolidation 1, largest_step 0.05. */
GRAINLAW_API grainlaw_consolidation grainlaw_consolidation_default(void);

/* Lead the committed states of some points to the Cauchy stress sigma[n*dim*dim] (symmetric, to 1e-8
 * of it), and make that the state at F = I. All or none. The shape and volume there are the
 * reference; DISSIPATED_ENERGY, BROKEN_BONDS and rotations count from there.
 *
 * Newton's method leads the symmetric stretch by the exact tangent. Of K0 the traction sigma n is led
 * as asked for, and the stress within the plane is what comes of it; n need not have length 1. With
 * overconsolidation the route leads to so much times sigma (ISOTROPIC: its mean) and back. With
 * solver.viscous_number every increment lasts long enough for drag to fade, whatever time the host
 * tells, and the state is held until none is left. Equal states that are to have equal stresses are
 * led once.
 *
 * how NULL: the default. reached[n*dim*dim] or NULL: the stress of each point there; where a point
 * fails, the last stress in balance on its way. status[n] or NULL. threads, summary and the returned
 * status are as of grainlaw_points_evaluate, and agreed by the ranks of a shared set. After a failure
 * every point is as it was. Errors, told in the summary's message: BAD_ARGUMENT (a wrong number of a point; sigma
 * not finite, not symmetric, or in tension where contacts bear none; boundary.stress; options),
 * NULL_POINTER, BAD_HANDLE, BAD_REPORT (size of how or summary), NOT_CONVERGED, CONTACTS_LOST,
 * COLLAPSED (more than the packing carries), OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_points_consolidate(grainlaw_points*, size_t n,
                                                         const size_t* which, const double* sigma,
                                                         const grainlaw_consolidation* how,
                                                         double* reached, grainlaw_status* status,
                                                         int threads, grainlaw_summary* summary);

/* ---- ranks ---------------------------------------------------------------------------------- */

typedef GRAINLAW_ENUM(grainlaw_op){
    GRAINLAW_MIN = 0, /* smallest of the ranks */
    GRAINLAW_SUM = 1  /* sum over the ranks */
} grainlaw_op;

/* Replace values[n] on every rank by what op makes of those of all ranks, e.g. by MPI_Allreduce in
 * place. */
typedef void (*grainlaw_reduce)(void* context, double* values, int n, grainlaw_op op);

/* Share the failures of a set with other ranks, each of which has a set of its own and a rank >= 0 of
 * its own. Evaluations and commits are then calls of all ranks together, a set of no points
 * included. Status and summary of an evaluation are the same on all: failed counts all points,
 * step_ratio is the smallest, and the first failed point is that of the lowest rank, fatal before
 * recoverable. All commit or none. reduce NULL: not shared any more. Copies are not shared. Errors:
 * NULL_POINTER, BAD_HANDLE, BAD_ARGUMENT (rank < 0). */
GRAINLAW_API grainlaw_status grainlaw_points_share(grainlaw_points*, int rank,
                                                   grainlaw_reduce reduce, void* context);

/* Agree on how something else went, e.g. reading a checkpoint: a call of all ranks together. `mine` is
 * this rank's status, message its text (zero-terminated) or "". Returns the status of the first
 * failed rank, fatal before recoverable, and message (may be NULL) receives its text, truncated to
 * message_size bytes; "" when all are OK. Errors: NULL_POINTER, BAD_HANDLE. */
GRAINLAW_API grainlaw_status grainlaw_points_agree(grainlaw_points*, grainlaw_status mine,
                                                   char* message, size_t message_size);

#ifdef __cplusplus
}
#endif

#endif
