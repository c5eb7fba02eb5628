/* Tables of points: for a host that calls for one point at a time and never says that an increment is
 * accepted. Included by grainlaw.h, whose conventions hold here too. */
#ifndef GRAINLAW_TABLE_H
#define GRAINLAW_TABLE_H

#include <grainlaw/grainlaw.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Points of one material, found by element and point; it grows as the host asks. Any number of
 * threads may call at once, for different points. */
typedef struct grainlaw_table grainlaw_table;

/* A table without points. Errors: NULL_POINTER, BAD_HANDLE, OUT_OF_MEMORY. On any error *out is NULL.
 */
GRAINLAW_API grainlaw_status grainlaw_table_create(const grainlaw_material*, grainlaw_table** out);

/* Release the handle (NULL is allowed) and its points. */
GRAINLAW_API void grainlaw_table_destroy(grainlaw_table*);

/* Number of points; 0 for a null or dead handle. */
GRAINLAW_API size_t grainlaw_table_size(const grainlaw_table*);

/* grainlaw_evaluate for a point, made at its first call, from the state that the host means.
 *
 * The host keeps *token for the point from one increment to the next, e.g. as a state variable, 0 at
 * first: the increments that the point has gone through. On return it is that of the answer, one
 * more. A call tells by it where it starts:
 *   - at the point's own number, the increment goes on or is tried again, from the committed state;
 *   - at one more, the last answer was accepted: it is committed first.
 * F0[dim*dim], which may be NULL, is F at the start of the increment. An accepted answer that was not
 * the last is found again from it; on a retry it has to be the committed F, to 1e-9.
 * token NULL: F0 alone tells. It is the committed F, to 1e-12, or that of the accepted answer.
 * F NULL: P and A at the committed F; no trial is left, and *token stays.
 *
 * time_step is that of grainlaw_state_set_time_step. P[dim*dim], A[dim^4], report: each may be NULL.
 * Errors: those of grainlaw_evaluate; BAD_ARGUMENT also for a token or F0 of no known state, and for
 * a point that another thread is evaluating: report->message says which. After any error the
 * committed state is that of the start, and *token is untouched. */
GRAINLAW_API grainlaw_status grainlaw_table_evaluate(grainlaw_table*, long long element,
                                                     long long point, double* token,
                                                     const double* F0, const double* F,
                                                     double time_step, unsigned want, double* P,
                                                     double* A, grainlaw_report* report);

/* grainlaw_state_measure of a point. Errors: those, and BAD_ARGUMENT for an unknown point. */
GRAINLAW_API grainlaw_status grainlaw_table_measure(const grainlaw_table*, long long element,
                                                    long long point, grainlaw_measure what,
                                                    double* value, size_t* count);

/* Release a point; its next call begins at F = I. Errors: NULL_POINTER, BAD_HANDLE, BAD_ARGUMENT (an
 * unknown point). */
GRAINLAW_API grainlaw_status grainlaw_table_forget(grainlaw_table*, long long element,
                                                   long long point);

/* Write all points to bytes, by element and point: tokens, and the committed states as by
 * grainlaw_state_save. While no other thread calls. bytes NULL: set *size to the required size.
 * Otherwise *size is the capacity on entry, the length on return. Errors: NULL_POINTER, BAD_HANDLE,
 * BUFFER_TOO_SMALL, OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_table_save(const grainlaw_table*, void* bytes, size_t* size);

/* Replace all points by saved ones; on any error nothing changes. While no other thread calls. message
 * as in grainlaw_points_load. A trial that was accepted after the bytes were written is found again
 * from its F0. Errors: NULL_POINTER, BAD_HANDLE, BAD_BYTES, WRONG_VERSION, WRONG_MATERIAL,
 * OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_table_load(grainlaw_table*, const void* bytes, size_t size,
                                                 char* message, size_t message_size);

#ifdef __cplusplus
}
#endif

#endif
