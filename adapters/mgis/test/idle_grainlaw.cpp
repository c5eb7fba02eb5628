// The part of grainlaw.h that the adapter calls, answering at once: all that is left of the time of
// a call is the adapter's.
#include <grainlaw/grainlaw.h>

#include <algorithm>

struct grainlaw_material {};
struct grainlaw_state {
  bool trial = false;
};

extern "C" {

const char* grainlaw_status_text(grainlaw_status) { return ""; }
grainlaw_report grainlaw_report_default() {
  grainlaw_report report{};
  report.size = sizeof report;
  return report;
}
grainlaw_status grainlaw_material_load(const char*, grainlaw_material** out, char*, size_t) {
  *out = new grainlaw_material;
  return GRAINLAW_OK;
}
grainlaw_status grainlaw_material_parse(const char*, const char*, grainlaw_material** out, char*,
                                        size_t) {
  *out = new grainlaw_material;
  return GRAINLAW_OK;
}
int grainlaw_material_dimension(const grainlaw_material*) { return 2; }
void grainlaw_material_destroy(grainlaw_material* material) { delete material; }
grainlaw_status grainlaw_state_create(const grainlaw_material*, grainlaw_state** out) {
  *out = new grainlaw_state;
  return GRAINLAW_OK;
}
grainlaw_status grainlaw_state_clone(const grainlaw_state* state, grainlaw_state** out) {
  *out = new grainlaw_state(*state);
  return GRAINLAW_OK;
}
void grainlaw_state_destroy(grainlaw_state* state) { delete state; }
grainlaw_status grainlaw_evaluate(grainlaw_state* state, const double* F, unsigned want, double* P,
                                  double* A, grainlaw_report* report) {
  for (int k = 0; k < 4; ++k) P[k] = -1e5 * F[k];  // S = -1e5 I, symmetric at any F
  if (want != 0) std::fill_n(A, 16, 1e8);
  report->step_ratio = 1;
  state->trial = true;
  return GRAINLAW_OK;
}
grainlaw_status grainlaw_state_set_time_step(grainlaw_state*, double) { return GRAINLAW_OK; }
grainlaw_status grainlaw_commit(grainlaw_state* state) {
  state->trial = false;
  return GRAINLAW_OK;
}
grainlaw_status grainlaw_revert(grainlaw_state* state) {
  state->trial = false;
  return GRAINLAW_OK;
}
grainlaw_status grainlaw_state_save(const grainlaw_state*, void*, size_t* size) {
  *size = 35000;
  return GRAINLAW_OK;
}

}  // extern "C"
