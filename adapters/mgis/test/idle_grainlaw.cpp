// The part of grainlaw.h that the adapter calls, answering at once: all that is left of the time of
// a call is the adapter's.
#include <grainlaw/grainlaw.h>
#include <grainlaw/march.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <new>
#include <utility>

struct grainlaw_material {};
struct grainlaw_state {};
struct grainlaw_table {
  std::mutex mutex;
  std::map<std::pair<long long, long long>, double> increments;
};

extern "C" {

const char* grainlaw_status_text(grainlaw_status) { return ""; }
double grainlaw_march_cut(double step_ratio) { return step_ratio > 0 ? step_ratio : 0.5; }
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
void grainlaw_state_destroy(grainlaw_state* state) { delete state; }
grainlaw_status grainlaw_table_create(const grainlaw_material*, grainlaw_table** out) {
  *out = new grainlaw_table;
  return GRAINLAW_OK;
}
void grainlaw_table_destroy(grainlaw_table* table) { delete table; }
size_t grainlaw_table_size(const grainlaw_table* table) { return table->increments.size(); }
grainlaw_status grainlaw_table_evaluate(grainlaw_table* table, long long element, long long point,
                                        double* token, const double*, const double* F, double,
                                        unsigned want, double* P, double* A,
                                        grainlaw_report* report) {
  try {
    const std::lock_guard lock(table->mutex);
    double& increments = table->increments[{element, point}];
    if (token != nullptr) increments = *token;
  } catch (const std::bad_alloc&) {
    return GRAINLAW_OUT_OF_MEMORY;
  }
  constexpr double start[] = {1, 0, 0, 1};
  for (int k = 0; k < 4; ++k) P[k] = -1e5 * (F == nullptr ? start : F)[k];  // S = -1e5 I, symmetric
  if (want != 0) std::fill_n(A, 16, 1e8);
  report->step_ratio = 1;
  if (token != nullptr) ++*token;
  return GRAINLAW_OK;
}
grainlaw_status grainlaw_table_measure(const grainlaw_table*, long long, long long,
                                       grainlaw_measure, double* value, size_t* count) {
  constexpr double start[] = {1, 0, 0, 1};
  *count = 4;
  if (value != nullptr) std::copy(start, start + 4, value);
  return GRAINLAW_OK;
}
grainlaw_status grainlaw_table_forget(grainlaw_table* table, long long element, long long point) {
  const std::lock_guard lock(table->mutex);
  table->increments.erase({element, point});
  return GRAINLAW_OK;
}
grainlaw_status grainlaw_table_save(const grainlaw_table*, void*, size_t* size) {
  *size = 0;
  return GRAINLAW_OK;
}
grainlaw_status grainlaw_table_load(grainlaw_table*, const void*, size_t, char*, size_t) {
  return GRAINLAW_OK;
}
grainlaw_status grainlaw_state_save(const grainlaw_state*, void*, size_t* size) {
  *size = 35000;
  return GRAINLAW_OK;
}

}  // extern "C"
