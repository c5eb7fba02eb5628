/* The march: which part of a load step comes next. Included by grainlaw.h, whose conventions hold
 * here too.
 *
 * The host assembles, solves, moves its unknowns and commits; the march says when. It cuts a load
 * step where a point or Newton's method fails, lets the parts grow again, and crosses jumps of the
 * stress. It owns no unknowns. A load step from load a to load b:
 *
 *   grainlaw_march_begin(march, a, b);
 *   while ((now = grainlaw_march_next(march, &part)) != GRAINLAW_DONE) {
 *     if (part.keep) farthest = u;
 *     switch (now) {
 *       case GRAINLAW_SOLVE:    solve for u at part.load; evaluate; grainlaw_march_tell;  break;
 *       case GRAINLAW_CROSS:    u = farthest; evaluate; grainlaw_march_tell;              break;
 *       case GRAINLAW_ACCEPT:   commit the points; committed = u;                         break;
 *       case GRAINLAW_BACK:     revert the points; u = committed;                         break;
 *       case GRAINLAW_GIVE_UP:  revert the points; u = committed; tell part.message;      return;
 *     }
 *   } */
#ifndef GRAINLAW_MARCH_H
#define GRAINLAW_MARCH_H

#include <grainlaw/grainlaw.h>
#include <grainlaw/points.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Position within a load step, and what was told of the current attempt. */
typedef struct grainlaw_march grainlaw_march;

typedef GRAINLAW_ENUM(grainlaw_action){
    GRAINLAW_SOLVE = 0,   /* solve once, move the unknowns, evaluate the points, tell */
    GRAINLAW_ACCEPT = 1,  /* commit the points and the unknowns */
    GRAINLAW_BACK = 2,    /* revert the points, return to the committed unknowns */
    GRAINLAW_CROSS = 3,   /* move to the iterate that was kept last, evaluate there, tell */
    GRAINLAW_GIVE_UP = 4, /* as BACK; the load step is over and failed */
    GRAINLAW_DONE = 5     /* the load step is over and its end is committed */
} grainlaw_action;

/* How to march. It starts with its own size and grows only at its end. */
typedef struct grainlaw_march_options {
  size_t size;        /* bytes of this struct in the caller's header */
  double tolerance;   /* |residual| / |scale| at which a part has converged, 1e-8 [-] */
  int max_iterations; /* solves of one attempt, 20 [-] */
  int max_cuts;       /* no part is smaller than its step / 2^max_cuts, 10; 0 to 1000 [-] */
  int patience;       /* iterations without halving the residual that end an attempt, 4 [-] */
  double largest_correction; /* of F per iteration, by its Frobenius norm; 0: no bound; 0.1 [-] */
  double crossing_part;      /* largest part over its step in which jumps are crossed, 1/16 [-] */
  int max_crossings; /* of one part, then it is accepted as loose, 8; 0: none is crossed [-] */
  double step_time;  /* time of a load step, told to the points, 1 [unit of the host] */
} grainlaw_march_options;

/* The defaults above, with the size set. */
GRAINLAW_API grainlaw_march_options grainlaw_march_options_default(void);

/* Where a march stands. It starts with its own size and grows only at its end. */
typedef struct grainlaw_part {
  size_t size;     /* bytes of this struct in the caller's header */
  double load;     /* to be reached by this attempt */
  double time;     /* that it takes, over the time of the step; 1 where the load stands still [-] */
  int keep;        /* 1: this iterate is the one to return to in a CROSS; store its unknowns */
  int complete;    /* 1: load is the end of the load step */
  int solves;      /* solves told in this load step [-] */
  int cuts;        /* parts that were cut in this load step [-] */
  int crossed;     /* jumps that were crossed in this load step [-] */
  int loose;       /* parts of this load step accepted out of balance, across jumps [-] */
  double residual; /* |residual| / |scale| told last; NaN before any, and of refused points [-] */
  char message[256]; /* after a failure of an attempt: why it failed, else "" */
} grainlaw_part;

/* An empty part with its size set. */
GRAINLAW_API grainlaw_part grainlaw_part_default(void);

/* A march. options NULL: the defaults. set (NULL: none) has to outlive it. The march tells the set the
 * time step of each attempt, and takes from it how far an iterate is from what was foreseen. Ranks that
 * share their sets (grainlaw_points_share) decide alike: create, begin and next of their marches alike,
 * and call share and tell together. Errors: NULL_POINTER, BAD_HANDLE, BAD_REPORT (unknown size of the
 * options), BAD_ARGUMENT (an option outside its range), OUT_OF_MEMORY. On any error *out is NULL. */
GRAINLAW_API grainlaw_status grainlaw_march_create(const grainlaw_march_options* options,
                                                   grainlaw_points* set, grainlaw_march** out);

/* Release the handle (NULL is allowed). */
GRAINLAW_API void grainlaw_march_destroy(grainlaw_march*);

/* Begin a load step at the committed load `from`. `to` may be smaller; where both are equal, the loads
 * act from the start and the step cannot be cut. Errors: NULL_POINTER, BAD_HANDLE, BAD_ARGUMENT (not
 * finite). */
GRAINLAW_API grainlaw_status grainlaw_march_begin(grainlaw_march*, double from, double to);

/* What the host does now; part may be NULL. The next call means that it is done. The first SOLVE of an
 * attempt begins at the committed unknowns. After an ACCEPT, the next attempt may be for the same
 * load: of a state beyond a jump, committed out of balance. Where that fails, the state is left so: the
 * BACK counts in part.loose, and the next part or DONE follows; where its residual was above 1, GIVE_UP.
 * GIVE_UP also for a null or dead handle, a part of unknown size, and before any load step. */
GRAINLAW_API grainlaw_action grainlaw_march_next(grainlaw_march*, grainlaw_part* part);

/* The share of a correction to apply, at most 1: its largest change of F (of this rank's points,
 * Frobenius norm) is then options.largest_correction. The rest of prescribed displacements comes in
 * the next iteration. 0 for a length that is not finite: the stiffness is singular; ask
 * grainlaw_march_next. Without this call corrections are applied whole. */
GRAINLAW_API double grainlaw_march_share(grainlaw_march*, double largest_change);

/* Tell the outcome of a SOLVE or CROSS. status and summary (NULL: none) are those of the
 * evaluation; a host that fails otherwise tells NOT_CONVERGED. residual and scale are norms, e.g. of the
 * force on the unknowns and of the nodal forces of the stresses; on several ranks of the unknowns that each
 * owns. unforeseen is the norm of the change of forces that the committed stiffness does not explain;
 * negative: taken from the set, which needs exact tangents for it. A host whose own solver iterates tells
 * once per attempt, with residual 0 when it converged. Errors: NULL_POINTER, BAD_HANDLE, BAD_REPORT (of the
 * summary), BAD_ARGUMENT (nothing is to be told now). */
GRAINLAW_API grainlaw_status grainlaw_march_tell(grainlaw_march*, grainlaw_status status,
                                                 const grainlaw_summary* summary, double residual,
                                                 double scale, double unforeseen);

/* The factor by which a march shortens a part that failed with this step ratio, 0.1 to 0.5; NaN: none was
 * suggested. For hosts that cut by themselves. */
GRAINLAW_API double grainlaw_march_cut(double step_ratio);

#ifdef __cplusplus
}
#endif

#endif
