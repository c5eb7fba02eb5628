/* What a C compiler makes of the lists in the headers, for header_test.py. */
#include <grainlaw/grainlaw.h>
#include <stdio.h>

#define FIELD(name) printf("Report %s %zu\n", #name, offsetof(grainlaw_report, name));
#define SUMMARY_FIELD(name) printf("Summary %s %zu\n", #name, offsetof(grainlaw_summary, name));

#define PARTICLE_FIELD(name) printf("Particle %s %zu\n", #name, offsetof(grainlaw_particle, name));
#define CONTACT_FIELD(name) printf("Contact %s %zu\n", #name, offsetof(grainlaw_contact, name));

int main(void) {
#define GRAINLAW_X(name, value, text) printf("Status %s %d\n", #name, (int)(name));
  GRAINLAW_STATUS_LIST(GRAINLAW_X)
#undef GRAINLAW_X
#define GRAINLAW_X(name, value, count, text) printf("Measure %s %d\n", #name, (int)(name));
  GRAINLAW_MEASURE_LIST(GRAINLAW_X)
#undef GRAINLAW_X
  printf("Tangent GRAINLAW_EXACT %d\n", GRAINLAW_WANT_TANGENT_EXACT);
  printf("Tangent GRAINLAW_ELASTIC %d\n", GRAINLAW_WANT_TANGENT_ELASTIC);
  printf("Tangent GRAINLAW_PERTURBED %d\n", GRAINLAW_WANT_TANGENT_PERTURBED);
  FIELD(size)
  FIELD(residual)
  FIELD(step_ratio)
  FIELD(relaxation_steps)
  FIELD(servo_corrections)
  FIELD(factorisations)
  FIELD(subincrements)
  FIELD(contacts)
  FIELD(sliding)
  FIELD(status_changes)
  FIELD(tangent_exact)
  FIELD(history_advanced)
  FIELD(message)
  FIELD(broken_bonds)
  FIELD(unbalanced)
  FIELD(viscous_work)
  FIELD(rattlers_loaded)
  SUMMARY_FIELD(size)
  SUMMARY_FIELD(step_ratio)
  SUMMARY_FIELD(failed)
  SUMMARY_FIELD(first_failed)
  SUMMARY_FIELD(message)
  SUMMARY_FIELD(rank)
  PARTICLE_FIELD(position)
  PARTICLE_FIELD(rotation)
  PARTICLE_FIELD(radius)
  PARTICLE_FIELD(source)
  PARTICLE_FIELD(contacts)
  CONTACT_FIELD(branch)
  CONTACT_FIELD(normal)
  CONTACT_FIELD(overlap)
  CONTACT_FIELD(normal_force)
  CONTACT_FIELD(tangential_force)
  CONTACT_FIELD(moment)
  CONTACT_FIELD(weight)
  CONTACT_FIELD(i)
  CONTACT_FIELD(j)
  CONTACT_FIELD(shift)
  CONTACT_FIELD(sliding)
  CONTACT_FIELD(bonded)
  printf("sizeof Particle %zu\n", sizeof(grainlaw_particle));
  printf("sizeof Contact %zu\n", sizeof(grainlaw_contact));
  printf("sizeof Report %zu\n", sizeof(grainlaw_report));
  printf("sizeof Summary %zu\n", sizeof(grainlaw_summary));
  return 0;
}
