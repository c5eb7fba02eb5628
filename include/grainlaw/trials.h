/* Trials of a set as bytes, so that another process evaluates a point as its owner would. Not
 * included by grainlaw.h. One point goes there and back like this, without a bit of difference:
 *   owner:  grainlaw_points_save_some, grainlaw_points_save_trials with evaluated = 0
 *   other:  grainlaw_points_load_some, grainlaw_points_load_trials, grainlaw_points_evaluate_some,
 *           grainlaw_points_save_trials with evaluated = 1
 *   owner:  grainlaw_points_load_trials */
#ifndef GRAINLAW_TRIALS_H
#define GRAINLAW_TRIALS_H

#include <grainlaw/grainlaw.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Write what the last evaluation of some points left beside P and A, also where it left no trial:
 * which[k] from offsets[k] to offsets[k + 1] of bytes. evaluated 0: only what the next evaluation
 * starts from, which is little unless solver.start = "trial". bytes, offsets and errors are as of
 * grainlaw_points_save_some. */
GRAINLAW_API grainlaw_status grainlaw_points_save_trials(const grainlaw_points*, size_t n,
                                                         const size_t* which, int evaluated,
                                                         void* bytes, size_t* offsets);

/* Replace the trials of some points, and what they cost, by saved ones, all or none. They have to come
 * from points of the same committed states, which is not checked. message and errors are as of
 * grainlaw_points_load_some. */
GRAINLAW_API grainlaw_status grainlaw_points_load_trials(grainlaw_points*, size_t n,
                                                         const size_t* which, const void* bytes,
                                                         const size_t* offsets, char* message,
                                                         size_t message_size);

#ifdef __cplusplus
}
#endif

#endif
