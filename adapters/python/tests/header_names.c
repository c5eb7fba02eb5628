/* What a C compiler makes of the lists in the headers, for header_test.py. */
#include <grainlaw/grainlaw.h>
#include <stdio.h>

#define FIELD(name) printf("Report %s %zu\n", #name, offsetof(grainlaw_report, name));
#define SUMMARY_FIELD(name) printf("Summary %s %zu\n", #name, offsetof(grainlaw_summary, name));

#define CONSOLIDATION_FIELD(name) \
  printf("Consolidation %s %zu\n", #name, offsetof(grainlaw_consolidation, name));
#define PARTICLE_FIELD(name) printf("Particle %s %zu\n", #name, offsetof(grainlaw_particle, name));
#define CONTACT_FIELD(name) printf("Contact %s %zu\n", #name, offsetof(grainlaw_contact, name));

#define PART_FIELD(name) printf("Part %s %zu\n", #name, offsetof(grainlaw_part, name));
#define OPTION_FIELD(name) \
  printf("MarchOptions %s %zu\n", #name, offsetof(grainlaw_march_options, name));
#define ACTION(name) printf("Action %s %d\n", #name, (int)(name));

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
  ACTION(GRAINLAW_SOLVE)
  ACTION(GRAINLAW_ACCEPT)
  ACTION(GRAINLAW_BACK)
  ACTION(GRAINLAW_CROSS)
  ACTION(GRAINLAW_GIVE_UP)
  ACTION(GRAINLAW_DONE)
  PART_FIELD(size)
  PART_FIELD(load)
  PART_FIELD(time)
  PART_FIELD(keep)
  PART_FIELD(complete)
  PART_FIELD(solves)
  PART_FIELD(cuts)
  PART_FIELD(crossed)
  PART_FIELD(loose)
  PART_FIELD(residual)
  PART_FIELD(message)
  OPTION_FIELD(size)
  OPTION_FIELD(tolerance)
  OPTION_FIELD(max_iterations)
  OPTION_FIELD(max_cuts)
  OPTION_FIELD(patience)
  OPTION_FIELD(largest_correction)
  OPTION_FIELD(crossing_part)
  OPTION_FIELD(max_crossings)
  OPTION_FIELD(step_time)
  CONSOLIDATION_FIELD(size)
  CONSOLIDATION_FIELD(route)
  CONSOLIDATION_FIELD(axis)
  CONSOLIDATION_FIELD(first_pressure)
  CONSOLIDATION_FIELD(overconsolidation)
  CONSOLIDATION_FIELD(largest_step)
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
  printf("sizeof Part %zu\n", sizeof(grainlaw_part));
  printf("sizeof MarchOptions %zu\n", sizeof(grainlaw_march_options));
  printf("sizeof Report %zu\n", sizeof(grainlaw_report));
  printf("sizeof Summary %zu\n", sizeof(grainlaw_summary));
  printf("sizeof Consolidation %zu\n", sizeof(grainlaw_consolidation));
  return 0;
}
