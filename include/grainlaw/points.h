/* Sets of points: what a finite element code does with all of its states at once. Included by
 * grainlaw.h, whose conventions hold here too.
 *
 * A set holds the integration points of one material, numbered from 0; a host with several materials
 * makes a set of each. When a load step has converged, or an evaluation of the set returned > 0:
 *   grainlaw_points_commit(set);
 *   grainlaw_points_revert(set);   and try a step smaller by summary.step_ratio
 */
#ifndef GRAINLAW_POINTS_H
#define GRAINLAW_POINTS_H

#include <grainlaw/grainlaw.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Many states of one material. */
typedef struct grainlaw_points grainlaw_points;

/* A set of n states as of grainlaw_state_create; n may be 0, as on a rank without elements. Errors:
 * NULL_POINTER, BAD_HANDLE, OUT_OF_MEMORY. On any error *out is NULL. */
GRAINLAW_API grainlaw_status grainlaw_points_create(const grainlaw_material*, size_t n,
                                                    grainlaw_points** out);

/* An independent copy, committed and trial. Errors as for create. */
GRAINLAW_API grainlaw_status grainlaw_points_clone(const grainlaw_points*, grainlaw_points** out);

/* Release the handle (NULL is allowed), and the states with it. */
GRAINLAW_API void grainlaw_points_destroy(grainlaw_points*);

/* Number of points; 0 for a null or dead handle. */
GRAINLAW_API size_t grainlaw_points_size(const grainlaw_points*);

/* The state of one point, to be measured, saved, cloned or written; NULL for a number that is none,
 * and for a null or dead handle. It is the set's, lives as long, and is always the same; what would
 * change or destroy it refuses it (BAD_HANDLE). */
GRAINLAW_API const grainlaw_state* grainlaw_points_state(const grainlaw_points*, size_t point);

/* What an evaluation of a set came to. Starts with its own size; grows only at its end. */
typedef struct grainlaw_summary {
  size_t size;       /* bytes of this struct as the caller knows it */
  double step_ratio; /* smallest step ratio of the failed points, 1 without any; 0: the step is not
                        what is wrong [-] */
  long failed;       /* points whose status is not OK [-] */
  long first_failed; /* number of the first, a fatal one before recoverable ones; -1: none */
  char message[256]; /* of that point, or why the call was refused; "" after success */
} grainlaw_summary;

/* A summary of no failures: its size set, step_ratio 1, first_failed -1, and the rest zero. */
GRAINLAW_API grainlaw_summary grainlaw_summary_default(void);

/* grainlaw_evaluate for all points of a set, on threads as grainlaw_evaluate_batch: F[n*dim*dim],
 * P[n*dim*dim] or NULL, A[n*dim^4] or NULL, status[n] or NULL, reports[n] or NULL, summary or NULL.
 * Returns OK when all points are OK, else the status of the first failed point, fatal before
 * recoverable. P and A of failed points are untouched, the others have theirs; a set with a failed
 * point cannot be committed. Refused before any point is touched, with all statuses the one that is
 * returned and summary.failed = 0: NULL_POINTER, BAD_ARGUMENT, BAD_REPORT of a report; with nothing
 * written at all: BAD_HANDLE, BAD_REPORT of the summary. Memory is taken by the points alone. */
GRAINLAW_API grainlaw_status grainlaw_points_evaluate(grainlaw_points*, const double* F,
                                                      unsigned want, double* P, double* A,
                                                      grainlaw_status* status,
                                                      grainlaw_report* reports, int threads,
                                                      grainlaw_summary* summary);

/* As grainlaw_state_set_time_step, of all points. */
GRAINLAW_API grainlaw_status grainlaw_points_set_time_step(grainlaw_points*, double time_step);

/* Make the trials the committed states, of all points or, where one has none, of none. Errors:
 * NULL_POINTER, BAD_HANDLE, NO_TRIAL. */
GRAINLAW_API grainlaw_status grainlaw_points_commit(grainlaw_points*);

/* Drop the trials, if any. Errors: NULL_POINTER, BAD_HANDLE. */
GRAINLAW_API grainlaw_status grainlaw_points_revert(grainlaw_points*);

/* Write the committed states of all points to bytes: each as by grainlaw_state_save, with a version
 * and a checksum of the whole. bytes NULL: set *size to the need. Otherwise *size is the capacity on
 * entry, the length on return. Errors: NULL_POINTER, BAD_HANDLE, BUFFER_TOO_SMALL. */
GRAINLAW_API grainlaw_status grainlaw_points_save(const grainlaw_points*, void* bytes,
                                                  size_t* size);

/* Replace the committed states of all points by saved bytes and drop the trials; a set of one takes
 * those of grainlaw_state_save too. Refuses what grainlaw_state_load refuses, and a set of another
 * size, and then changes nothing. message (may be
 * NULL) gets a zero-terminated text that names the point and what is wrong, truncated to message_size
 * bytes; it is set to "" on success. Errors: NULL_POINTER, BAD_HANDLE, BAD_BYTES, WRONG_VERSION,
 * WRONG_MATERIAL, BAD_ARGUMENT (another number of points), OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_points_load(grainlaw_points*, const void* bytes, size_t size,
                                                  char* message, size_t message_size);

/* A measure of all points, values[n * components], point by point, each as grainlaw_state_measure
 * gives it. values NULL: set *count to n * components. Otherwise *count is the capacity on entry, the
 * number written on return. On any error nothing is written. Errors: NULL_POINTER, BAD_HANDLE,
 * BAD_ARGUMENT (unknown measure), BUFFER_TOO_SMALL, OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_points_measure(const grainlaw_points*, grainlaw_measure what,
                                                     double* values, size_t* count);

#ifdef __cplusplus
}
#endif

#endif
