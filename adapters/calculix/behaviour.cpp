// One call of CalculiX: the state of an element's point, the packing's answer, PK2 and 21 numbers.
#include "floating_environment.hpp"
#include "library_points.hpp"
#include "material_file.hpp"
#include "point.hpp"

#include <grainlaw/calculix.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <unordered_map>

namespace grainlaw::adapters {
namespace {

constexpr std::array<std::size_t, 6> order{0, 4, 8, 1, 2, 5};  // 11 22 33 12 13 23
constexpr double rounding = 1e-12;    // of F, which CalculiX computes from displacements
constexpr double default_cut = 0.25;  // CalculiX's own, when an increment diverges
constexpr double largest_cut = 0.5;   // a factor that comes near 1 gains nothing
constexpr double soft = 1;            // Pa; keeps the host's matrix regular without a material

struct ElementPoint : Point {
  using Point::Point;
  bool started = false;
  // The last answer, and the time step of its increment; CalculiX asks again for what it has just got.
  Tensor2 asked{};
  double asked_time = 0;
  bool has_stress = false, has_stiffness = false;
  std::array<double, 6> stress{};
  std::array<double, 21> stiffness{};
};

class PointMap {
 public:
  PointMap(const char* name, const char* path, const void* in_library)
      : file_(name, path, in_library) {}

  ElementPoint& find(int element, int point) {
    const grainlaw::Material& material = file_.material();
    const auto key = static_cast<std::uint64_t>(element) << 32 | static_cast<std::uint32_t>(point);
    const std::lock_guard lock(mutex_);
    std::unique_ptr<ElementPoint>& found = points_[key];
    if (!found) found = std::make_unique<ElementPoint>(material);
    return *found;
  }

  // Prints a text that has not been told yet.
  void tell(const char* material, const std::string& text) {
    const std::lock_guard lock(mutex_);
    if (told_.size() == most_told || !told_.insert(text).second) return;
    std::printf("\n *ERROR in grainlaw, material %s: %s\n\n", material, text.c_str());
    if (told_.size() == most_told) {
      std::printf(" *ERROR in grainlaw, material %s: no more errors are printed\n\n", material);
    }
    std::fflush(stdout);
  }

 private:
  static constexpr std::size_t most_told = 1000;

  MaterialFile file_;
  std::mutex mutex_;
  std::unordered_map<std::uint64_t, std::unique_ptr<ElementPoint>> points_;
  std::set<std::string> told_;
};

Tensor2 from_columns(const double* F) {
  return {F[0], F[3], F[6], F[1], F[4], F[7], F[2], F[5], F[8]};
}

void keep(ElementPoint& point, const Response& response, bool with_stiffness) {
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

// Stress and elastic stiffness at the start of the increment, after no time.
void give_start(ElementPoint& point, double* stress, double* stiffness) {
  give_soft(stress, stiffness);
  point.set_time_step(0);
  Response response;
  const Answer answer = point.evaluate(point.committed(), GRAINLAW_WANT_TANGENT_ELASTIC, response);
  point.revert();
  point.has_stress = point.has_stiffness = false;
  if (answer.status != GRAINLAW_OK) return;
  keep(point, response, true);
  std::copy(point.stress.begin(), point.stress.end(), stress);
  std::copy(point.stiffness.begin(), point.stiffness.end(), stiffness);
}

void cut(double* pnewdt, double ratio) { *pnewdt = *pnewdt > 0 ? std::min(*pnewdt, ratio) : ratio; }

void evaluate(ElementPoint& point, const Tensor2& F0, const Tensor2& F1, double time_step,
              bool stress_only, double* stress, double* stiffness, double* pnewdt) {
  const std::lock_guard in_use(point.in_use);
  try {
    if (!(Point::distance(F0, point.committed()) <= rounding)) {
      if (!point.started) {
        throw std::runtime_error(
            "the first increment does not start at the undeformed configuration; an analysis "
            "cannot be restarted without its states");
      }
      point.set_time_step(point.asked_time);
      point.accept(F0);
      point.has_stress = point.has_stiffness = false;
    }
    const bool known = point.has_stress && point.asked == F1 && point.asked_time == time_step &&
                       (stress_only || point.has_stiffness);
    if (!known) {
      point.started = true;
      point.has_stress = point.has_stiffness = false;
      point.set_time_step(time_step);
      Response response;
      const Answer answer = point.evaluate_symmetric(
          F1, stress_only ? 0u : unsigned{GRAINLAW_WANT_TANGENT_EXACT}, response);
      if (answer.status != GRAINLAW_OK) {
        give_start(point, stress, stiffness);
        const double ratio = answer.report.step_ratio;
        cut(pnewdt, ratio > 0 ? std::min(ratio, largest_cut) : largest_cut);  // 0: goes on
        return;
      }
      keep(point, response, !stress_only);
      point.asked = F1;
      point.asked_time = time_step;
      point.has_stress = true;
      point.has_stiffness = !stress_only;
    }
    std::copy(point.stress.begin(), point.stress.end(), stress);
    if (!stress_only) std::copy(point.stiffness.begin(), point.stiffness.end(), stiffness);
  } catch (...) {
    give_start(point, stress, stiffness);
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
  PointMap* points = nullptr;
  ElementPoint* found = nullptr;
  try {
    points = &points_of<PointMap>(material);
    found = &points->find(element, point);
    evaluate(*found, from_columns(F0), from_columns(F1), time_step_of(dtime), stress_only != 0,
             stress, stiffness, pnewdt);
  } catch (const std::exception& error) {
    if (found == nullptr) give_soft(stress, stiffness);
    cut(pnewdt, default_cut);
    if (points == nullptr) return;  // no memory for anything
    try {
      std::string text = error.what();
      if (found != nullptr) {
        text =
            "element " + std::to_string(element) + ", point " + std::to_string(point) + ": " + text;
      }
      points->tell(material->name, text);
    } catch (const std::exception&) {  // nor for the text
    }
  }
}

void grainlaw_calculix_release(grainlaw_calculix_material* material) {
  grainlaw::adapters::release_points<grainlaw::adapters::PointMap>(material);
}

}  // extern "C"
