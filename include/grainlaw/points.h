/* Sets of points: operations of a finite element code on all of its states. Included by grainlaw.h,
 * whose conventions hold here too.
 *
 * A set contains the integration points of one material, numbered from 0; a host with several
 * materials creates one set per material. After a converged load step, or after an evaluation of
 * the set that returned > 0:
 *   grainlaw_points_commit(set);
 *   grainlaw_points_revert(set);   and retry with a step smaller by summary.step_ratio */
#ifndef GRAINLAW_POINTS_H
#define GRAINLAW_POINTS_H

#include <grainlaw/grainlaw.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Many states of one material. */
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
} grainlaw_summary;

/* A summary without failures: its size set, step_ratio 1, first_failed -1, zeros elsewhere. */
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

/* Write the committed states of all points to bytes: each as by grainlaw_state_save, with a version
 * and a checksum of the whole. bytes NULL: set *size to the required size. Otherwise *size is the
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

#ifdef __cplusplus
}
#endif

#endif
