// One call of CalculiX: the state of an element's point, the packing's answer, PK2 and 21 numbers.
#include "floating_environment.hpp"
#include "library_points.hpp"
#include "material_file.hpp"
#include "point.hpp"
#include "told_once.hpp"

#include <grainlaw/calculix.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace grainlaw::adapters {
namespace {

constexpr std::array<std::size_t, 6> order{0, 4, 8, 1, 2, 5};  // 11 22 33 12 13 23
constexpr double soft = 1;  // Pa; keeps the host's matrix regular without a material

// The last answer of a point: CalculiX asks again for what it has just got.
struct LastAnswer {
  std::mutex in_use;
  Tensor2 F0{}, F1{};
  double time_step = 0;
  bool has_stress = false, has_stiffness = false;
  std::array<double, 6> stress{};
  std::array<double, 21> stiffness{};
};

class Points {
 public:
  Points(const char* name, const char* path, const void* in_library)
      : file_(name, path, in_library) {}

  grainlaw::Table& table() {
    const grainlaw::Material& material = file_.material();
    const std::lock_guard lock(mutex_);
    if (!table_) table_.emplace(material);
    return *table_;
  }

  LastAnswer& last_answer(int element, int point) {
    const std::lock_guard lock(mutex_);
    return answers_[{element, point}];
  }

  ToldOnce errors;

 private:
  MaterialFile file_;
  std::mutex mutex_;
  std::optional<grainlaw::Table> table_;
  std::map<std::pair<int, int>, LastAnswer> answers_;
};

Tensor2 from_columns(const double* F) {
  return {F[0], F[3], F[6], F[1], F[4], F[7], F[2], F[5], F[8]};
}

void keep(LastAnswer& point, const Response& response, bool with_stiffness) {
  const Tensor2 stress = second_piola_stress(response);
  for (std::size_t a = 0; a < order.size(); ++a) point.stress[a] = stress[order[a]];
  if (!with_stiffness) return;
  Tensor4 tangent;
  second_piola_by_green(response, tangent);
  std::size_t next = 0;
  for (std::size_t b = 0; b < order.size(); ++b) {
    for (std::size_t a = 0; a <= b; ++a) {
      point.stiffness[next++] =
          (tangent[9 * order[a] + order[b]] + tangent[9 * order[b] + order[a]]) / 2;
    }
  }
}

// A regular matrix, whatever else is wrong.
void give_soft(double* stress, double* stiffness) {
  std::fill_n(stress, 6, 0.0);
  std::size_t next = 0;
  for (std::size_t b = 0; b < 6; ++b) {
    for (std::size_t a = 0; a <= b; ++a) stiffness[next++] = a == b ? soft : 0;
  }
}

// Stress and elastic stiffness at the start of the increment, after no time: at F0 or, where that is
// of no known state, at the committed F.
void give_start(grainlaw::Table& table, int element, int point, LastAnswer& last, const Tensor2& F0,
                double* stress, double* stiffness) {
  give_soft(stress, stiffness);
  last.has_stress = last.has_stiffness = false;
  for (const Tensor2* const from : {&F0, static_cast<const Tensor2*>(nullptr)}) {
    try {
      Response response;
      const PointCall at_start{
          element, point, nullptr, from, nullptr, 0, GRAINLAW_WANT_TANGENT_ELASTIC};
      if (evaluate(table, at_start, response).status != GRAINLAW_OK) continue;
      keep(last, response, true);
      std::copy(last.stress.begin(), last.stress.end(), stress);
      std::copy(last.stiffness.begin(), last.stiffness.end(), stiffness);
      return;
    } catch (const std::exception&) {  // the first reason is told
    }
  }
}

void cut(double* pnewdt, double ratio) { *pnewdt = *pnewdt > 0 ? std::min(*pnewdt, ratio) : ratio; }

void evaluate(grainlaw::Table& table, int element, int point, LastAnswer& last, const Tensor2& F0,
              const Tensor2& F1, double time_step, bool stress_only, double* stress,
              double* stiffness, double* pnewdt) {
  const std::lock_guard in_use(last.in_use);
  try {
    const bool known = last.has_stress && last.F0 == F0 && last.F1 == F1 &&
                       last.time_step == time_step && (stress_only || last.has_stiffness);
    if (!known) {
      last.has_stress = last.has_stiffness = false;
      const unsigned want = stress_only ? 0u : unsigned{GRAINLAW_WANT_TANGENT_EXACT};
      Response response;
      const Answer answer =
          evaluate_symmetric(table, {element, point, nullptr, &F0, &F1, time_step, want}, response);
      if (answer.status != GRAINLAW_OK) {
        give_start(table, element, point, last, F0, stress, stiffness);
        cut(pnewdt, grainlaw_march_cut(answer.report.step_ratio));
        return;
      }
      keep(last, response, !stress_only);
      last.F0 = F0;
      last.F1 = F1;
      last.time_step = time_step;
      last.has_stress = true;
      last.has_stiffness = !stress_only;
    }
    std::copy(last.stress.begin(), last.stress.end(), stress);
    if (!stress_only) std::copy(last.stiffness.begin(), last.stiffness.end(), stiffness);
  } catch (...) {
    give_start(table, element, point, last, F0, stress, stiffness);
    throw;
  }
}

}  // namespace
}  // namespace grainlaw::adapters

extern "C" {

void grainlaw_calculix_evaluate(grainlaw_calculix_material* material, int element, int point,
                                const double* F0, const double* F1, double dtime, int stress_only,
                                double* stress, double* stiffness, double* pnewdt) {
  using namespace grainlaw::adapters;
  const FloatingEnvironment environment;
  Points* points = nullptr;
  LastAnswer* found = nullptr;
  try {
    points = &points_of<Points>(material);
    grainlaw::Table& table = points->table();
    found = &points->last_answer(element, point);
    evaluate(table, element, point, *found, from_columns(F0), from_columns(F1), time_step_of(dtime),
             stress_only != 0, stress, stiffness, pnewdt);
  } catch (const std::exception& error) {
    if (found == nullptr) give_soft(stress, stiffness);
    cut(pnewdt, grainlaw_march_cut(NAN));  // no ratio was suggested
    if (points == nullptr) return;         // no memory for anything
    try {
      std::string text = error.what();
      if (found != nullptr) {
        text =
            "element " + std::to_string(element) + ", point " + std::to_string(point) + ": " + text;
      }
      points->errors.tell(material->name, text);
    } catch (const std::exception&) {  // nor for the text
    }
  }
}

void grainlaw_calculix_release(grainlaw_calculix_material* material) {
  grainlaw::adapters::release_points<grainlaw::adapters::Points>(material);
}

}  // extern "C"
