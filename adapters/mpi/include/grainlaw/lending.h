/* Lending of points between ranks of MPI: a rank that is done with its own points evaluates points of
 * others, the dearest first. Answers are those without, bit by bit, whichever rank finds them. Ranks
 * run one version of the library on one kind of machine. All functions but grainlaw_lending_count are
 * calls of all ranks together. Statuses are those of grainlaw.h. */
#ifndef GRAINLAW_LENDING_H
#define GRAINLAW_LENDING_H

#include <grainlaw/grainlaw.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct grainlaw_lending grainlaw_lending;

/* Let the ranks of a communicator (MPI_Comm_c2f of it) lend points of their sets, which may have none.
 * materials[n] are the same on all ranks, in one order; material_of[k] numbers that of point k, NULL:
 * all are of the first. The set is shared (grainlaw_points_share) and has to outlive the handle.
 * message (may be NULL) receives a zero-terminated text, truncated to message_size bytes. Errors, the
 * same on all ranks: NULL_POINTER, BAD_HANDLE, BAD_ARGUMENT (numbers, or MPI is not running),
 * WRONG_MATERIAL, OUT_OF_MEMORY. On any error *out is NULL, and the set is not shared. */
GRAINLAW_API grainlaw_status grainlaw_lending_create(int communicator, grainlaw_points* set,
                                                     size_t n,
                                                     const grainlaw_material* const* materials,
                                                     const int* material_of, grainlaw_lending** out,
                                                     char* message, size_t message_size);

/* Release the handle (NULL is allowed); the set is shared no more. After MPI_Finalize it is a call of
 * one rank. */
GRAINLAW_API void grainlaw_lending_destroy(grainlaw_lending*);

/* grainlaw_points_evaluate for the set, in one thread of each rank: the same arguments, answers, status
 * and summary. Points whose last evaluation was dearer than their moving may be lent, so the first
 * evaluation lends none. */
GRAINLAW_API grainlaw_status grainlaw_lending_evaluate(grainlaw_lending*, const double* F,
                                                       unsigned want, double* P, double* A,
                                                       grainlaw_status* status,
                                                       grainlaw_report* reports,
                                                       grainlaw_summary* summary);

/* What lending did on this rank since it was created. It starts with its own size and grows only at
 * its end. */
typedef struct grainlaw_lent {
  size_t size;     /* bytes of this struct in the caller's header */
  long offered;    /* points that others could have taken [-] */
  long lent;       /* of these, points that others evaluated [-] */
  long taken;      /* points of others that this rank evaluated [-] */
  double bytes;    /* that it got and gave back for these [byte] */
  double packing;  /* processor time of offering, and of taking answers over [s] */
  double carrying; /* processor time of getting points of others and giving them back [s] */
  double own;      /* processor time of evaluating own points [s] */
  double seconds;  /* processor time of evaluating points of others [s] */
} grainlaw_lent;

GRAINLAW_API grainlaw_lent grainlaw_lending_count(const grainlaw_lending*);

#ifdef __cplusplus
}
#endif

#endif
