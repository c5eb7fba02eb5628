#include "evidence/studies/stability/cases.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace verification::stability {

void add(Cases& cases, std::string group, std::string setting, std::function<Material()> material,
         Path path, std::function<Check(const Walk&)> check) {
  Case one;
  one.group = std::move(group);
  one.setting = std::move(setting);
  one.material = std::move(material);
  one.path = std::move(path);
  one.check = std::move(check);
  cases.push_back(std::move(one));
}

double stress_distance(const std::vector<Point>& points, const std::vector<Tensor>& other) {
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

}  // namespace verification::stability
