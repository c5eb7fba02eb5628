/* Particles and contacts of a state, as arrays. Included by grainlaw.h, whose conventions hold here
 * too.
 *
 * Vectors have three components in either dimension. For discs the third component of a position or
 * a force is 0. Rotations and moments of discs are about axis 3, anticlockwise positive: the third
 * component alone. */
#ifndef GRAINLAW_PARTICLES_H
#define GRAINLAW_PARTICLES_H

#include <grainlaw/grainlaw.h>

#ifdef __cplusplus
extern "C" {
#endif

/* One particle, copies on a frame included. The struct grows only at its end. */
typedef struct grainlaw_particle {
  double position[3]; /* position of the centre, not wrapped into a periodic cell [m] */
  double rotation[3]; /* rotation since F = I, for spheres a rotation vector [rad] */
  double radius;      /* [m] */
  int source;         /* identity of the particle, from 0; copies on a frame share it [-] */
  int contacts;       /* its touching contacts, as grainlaw_state_contacts lists them [-] */
} grainlaw_particle;

/* One touching contact of particle i with particle j or its periodic image. The struct grows only
 * at its end. In a periodic cell without drag the Cauchy stress is - sum f branch / volume with the
 * force on j, f = normal_force normal + tangential_force. */
typedef struct grainlaw_contact {
  double branch[3];           /* from the centre of i to that of j [m] */
  double normal[3];           /* unit vector along the branch [-] */
  double overlap;             /* R_i + R_j less the length of the branch [m] */
  double normal_force;        /* on j along the normal; negative for a bond in tension [N] */
  double tangential_force[3]; /* on j [N] */
  double moment[3];           /* on j, of rolling, twisting, bending or torsion [N m] */
  double weight;              /* 1, or 1 / copies of the contact on a frame [-] */
  int i, j;                   /* indices of the particles, from 0 [-] */
  int shift[3];               /* periods of the cell by which the image of j is displaced [-] */
  int sliding;                /* 1: at the friction limit */
  int bonded;                 /* 1: by an intact bond */
} grainlaw_contact;

/* Particles of the trial state, or of the committed one without a trial. particle_size is
 * sizeof(grainlaw_particle) of the caller; an earlier header receives the fields it knows.
 * particles NULL: set *count to their number. Otherwise *count is the capacity on entry, the number
 * written on return. On any error nothing is written. Errors: NULL_POINTER, BAD_HANDLE,
 * BAD_ARGUMENT (unknown size), BUFFER_TOO_SMALL, OUT_OF_MEMORY. */
GRAINLAW_API grainlaw_status grainlaw_state_particles(const grainlaw_state*,
                                                      grainlaw_particle* particles,
                                                      size_t particle_size, size_t* count);

/* Touching contacts of the trial state, or of the committed one without a trial, ordered by i, j
 * and shift. Arguments and errors: those of grainlaw_state_particles. */
GRAINLAW_API grainlaw_status grainlaw_state_contacts(const grainlaw_state*,
                                                     grainlaw_contact* contacts,
                                                     size_t contact_size, size_t* count);

#ifdef __cplusplus
}
#endif

#endif
