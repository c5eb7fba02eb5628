#include "evidence/studies/stability/cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace verification::stability {

namespace {

template <int D>
Case make(std::string group, std::string setting, std::function<Material()> material,
          PathOf<D> path, CheckOf<D> check) {
  Case one;
  one.group = std::move(group);
  one.setting = std::move(setting);
  one.material = std::move(material);
  one.increments = static_cast<int>(path.targets.size());
  one.skips = path.surrender == Surrender::skip_the_increment;
  one.walk = [path = std::move(path), check = std::move(check)](const Material& made) {
    const WalkOf<D> walked = walk(made, path);
    // What is compared is a whole path.
    const bool compared = check && walked.gave_up.empty();
    return Walked{walked, compared ? std::optional(check(walked)) : std::nullopt};
  };
  return one;
}

}  // namespace

void add(Cases& cases, std::string group, std::string setting, std::function<Material()> material,
         Path path, CheckOf<2> check) {
  cases.push_back(make<2>(std::move(group), std::move(setting), std::move(material),
                          std::move(path), std::move(check)));
}

void add_spheres(Cases& cases, bool must_converge, const std::string& group, std::string setting,
                 std::function<Material()> material, PathOf<3> path, CheckOf<3> check) {
  cases.push_back(make<3>("spheres, " + group, std::move(setting), std::move(material),
                          std::move(path), std::move(check)));
  cases.back().must_converge = must_converge;
}

template <int D>
double stress_distance(const std::vector<PointOf<D>>& points,
                       const std::vector<TensorOf<D>>& other) {
  if (other.size() < points.size()) return std::numeric_limits<double>::quiet_NaN();
  double distance = 0;
  double scale = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    distance = std::max(distance, (points[k].stress - other[k]).norm());
    scale = std::max(scale, other[k].norm());
  }
  return scale > 0 ? distance / scale : distance;
}

std::vector<Tensor> stresses_of(const Walk& walk) {
  std::vector<Tensor> stresses;
  for (const Point& point : walk.points) stresses.push_back(point.stress);
  return stresses;
}

template <int D>
Check against_unrotated(const Material& material, const WalkOf<D>& walk, double angle,
                        const TargetsOf<D>& still) {
  const WalkOf<D> reference = stability::walk(material, PathOf<D>{.targets = still});
  std::vector<TensorOf<D>> rotated;
  for (std::size_t k = 0; k < reference.points.size(); ++k)
    rotated.push_back(rotation<D>(angle * static_cast<double>(k)) * reference.points[k].stress);
  return {stress_distance(walk.points, rotated), 1e-4, "the same without rotation, turned"};
}

template <int D>
Check bears_again(const WalkOf<D>& walk) {
  double lost = 0;
  for (const PointOf<D>& point : walk.points) lost = std::max(lost, point.lost ? 1.0 : 0.0);
  const double ratio = walk.points.back().stress.norm() / walk.points.front().stress.norm();
  // A packing compacts when it is shaken: any stress of the first one's order will do.
  const bool right = lost > 0 && ratio > 0.1 && ratio < 10;
  return {right ? 0.0 : 1.0, 0.5,
          fmt::format("contacts lost: {}; |P| back to {:.4g} of the first", lost > 0 ? "yes" : "no",
                      ratio)};
}

#define GRAINLAW_FOR(D)                                                       \
  template double stress_distance(const std::vector<PointOf<D>>&,             \
                                  const std::vector<TensorOf<D>>&);           \
  template Check against_unrotated(const Material&, const WalkOf<D>&, double, \
                                   const TargetsOf<D>&);                      \
  template Check bears_again(const WalkOf<D>&);
GRAINLAW_FOR(2)
GRAINLAW_FOR(3)

}  // namespace verification::stability
