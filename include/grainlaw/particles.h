/* Particles and contacts of a state, as arrays. Included by grainlaw.h, whose conventions hold here too.
 *
 * Vectors have three components in either dimension. Of discs the third of a place or a force is 0, and
 * rotations and moments are about axis 3, anticlockwise positive: the third alone.
 */
#ifndef GRAINLAW_PARTICLES_H
#define GRAINLAW_PARTICLES_H

#include <grainlaw/grainlaw.h>

#ifdef __cplusplus
extern "C" {
#endif

/* One particle, copies on a frame included. Grows only at its end. */
typedef struct grainlaw_particle {
  double position[3]; /* of its centre, not wrapped into a periodic cell [m] */
  double rotation[3]; /* since F = I, of spheres a rotation vector [rad] */
  double radius;      /* [m] */
  int source;         /* which particle it is, from 0: copies on a frame have one number [-] */
  int contacts;       /* of it that touch, as grainlaw_state_contacts lists them [-] */
} grainlaw_particle;

/* One touching contact, of particle i with particle j or its periodic image. Grows only at its end.
 * In a periodic cell without drag the Cauchy stress is - sum f branch / volume with the force on j,
 * f = normal_force normal + tangential_force. */
typedef struct grainlaw_contact {
  double branch[3];           /* from the centre of i to that of j [m] */
  double normal[3];           /* the branch of length 1 [-] */
  double overlap;             /* R_i + R_j less the length of the branch [m] */
  double normal_force;        /* on j along the normal; negative in the tension of a bond [N] */
  double tangential_force[3]; /* on j [N] */
  double moment[3];           /* of rolling, twisting, bending or torsion, on j [N m] */
  double weight;              /* 1, or 1 / copies of the contact on a frame [-] */
  int i, j;                   /* numbers of the particles, from 0 [-] */
  int shift[3];               /* periods of the cell by which the image of j is displaced [-] */
  int sliding;                /* 1: at the limit of friction */
  int bonded;                 /* 1: by a bond that holds */
} grainlaw_contact;

/* Particles of the trial state, or of the committed one when there is no trial. particle_size is
 * sizeof(grainlaw_particle) of the caller: an earlier header's gets what it knows. particles NULL: set
 * *count to their number. Otherwise *count is the capacity on entry, the number written on return. On
 * any error nothing is written. Errors: NULL_POINTER, BAD_HANDLE, BAD_ARGUMENT (unknown size),
 * BUFFER_TOO_SMALL, OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_state_particles(const grainlaw_state*,
                                                      grainlaw_particle* particles,
                                                      size_t particle_size, size_t* count);

/* Touching contacts of the same state, ordered by i, j and shift, in the same way. */
GRAINLAW_API grainlaw_status grainlaw_state_contacts(const grainlaw_state*,
                                                     grainlaw_contact* contacts,
                                                     size_t contact_size, size_t* count);

#ifdef __cplusplus
}
#endif

#endif
