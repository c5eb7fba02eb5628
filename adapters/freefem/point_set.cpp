#include "point_set.hpp"

#include "whole_file.hpp"

#include <algorithm>
#include <cctype>
#include <climits>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numeric>
#include <span>
#include <stdexcept>

namespace grainlaw_freefem {
namespace {

using grainlaw::check;

std::string shown(const std::vector<std::size_t>& shape) {
  std::string text;
  for (const std::size_t extent : shape)
    text += (text.empty() ? "" : " x ") + std::to_string(extent);
  return text;
}

// Throws unless the array is [components, points], or holds as many numbers in one row.
void expect(const char* name, const Array& array, std::size_t components, std::size_t points) {
  const std::vector<std::size_t> shape{components, points};
  if (array.shape == shape || array.shape == std::vector<std::size_t>{components * points}) return;
  throw std::invalid_argument(std::string(name) + " is " + shown(array.shape) + ", expected " +
                              shown(shape) + " (components by points)");
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return text;
}

struct NamedMeasure {
  std::string name;
  grainlaw_measure value;
};

const std::vector<NamedMeasure>& measures() {
  static const std::vector<NamedMeasure> list = [] {
    std::vector<NamedMeasure> all;
#define GRAINLAW_FREEFEM_X(name, value, count, text) \
  all.push_back({lower_case(#name).substr(std::strlen("grainlaw_")), name});
    GRAINLAW_MEASURE_LIST(GRAINLAW_FREEFEM_X)
#undef GRAINLAW_FREEFEM_X
    return all;
  }();
  return list;
}

grainlaw_measure measure_named(const std::string& name) {
  std::string names;
  for (const NamedMeasure& entry : measures()) {
    if (entry.name == name) return entry.value;
    names += (names.empty() ? "" : ", ") + entry.name;
  }
  throw std::invalid_argument("there is no measure \"" + name + "\", expected one of " + names);
}

grainlaw::Points create(const std::vector<std::string>& material_paths,
                        const std::vector<long>& points) {
  if (material_paths.empty() || material_paths.size() != points.size())
    throw std::invalid_argument(std::to_string(material_paths.size()) + " materials and " +
                                std::to_string(points.size()) +
                                " numbers of points, expected as many of both");
  const long fewest = *std::min_element(points.begin(), points.end());
  if (fewest < 0)
    throw std::invalid_argument("a number of points is " + std::to_string(fewest) +
                                ", expected at least 0");
  std::vector<grainlaw::Material> materials;
  for (const std::string& path : material_paths)
    materials.push_back(grainlaw::Material::load(path));
  grainlaw::Points all(materials[0], static_cast<std::size_t>(points[0]));
  for (std::size_t k = 1; k < materials.size(); ++k)
    all.resize(all.size() + static_cast<std::size_t>(points[k]), materials[k]);
  return all;
}

grainlaw_route route_named(const std::string& name) {
  if (name == "k0") return GRAINLAW_K0;
  if (name == "proportional") return GRAINLAW_PROPORTIONAL;
  if (name == "isotropic") return GRAINLAW_ISOTROPIC;
  throw std::invalid_argument("the route is \"" + name +
                              "\", expected \"k0\", \"proportional\" or \"isotropic\"");
}

}  // namespace

PointSet::PointSet(const std::vector<std::string>& material_paths, const std::vector<long>& points)
    : points_(create(material_paths, points)) {}

long PointSet::evaluate(const Array& F, const Array& P, const Array* A, long threads) {
  const std::size_t n = points_.size();
  const auto square = static_cast<std::size_t>(dimension() * dimension());
  expect("F", F, square, n);
  expect("P", P, square, n);
  if (A != nullptr) expect("A", *A, square * square, n);
  if (threads < 0 || threads > INT_MAX)
    throw std::invalid_argument("threads is " + std::to_string(threads) +
                                ", expected 0 (as many as the library takes) or a number of them");
  const unsigned want = A != nullptr ? unsigned{GRAINLAW_WANT_TANGENT_EXACT} : 0u;
  const std::span tangent(A != nullptr ? A->data : nullptr, A != nullptr ? n * square * square : 0);
  last_ = {};
  try {
    last_ = points_.evaluate({F.data, n * square}, {P.data, n * square}, want, tangent,
                             static_cast<int>(threads));
  } catch (...) {
    points_.revert();
    throw;
  }
  return last_.summary.failed;
}

long PointSet::answer(const Array& P, const Array* A) {
  const std::size_t n = points_.size();
  const auto square = static_cast<std::size_t>(dimension() * dimension());
  expect("P", P, square, n);
  if (A != nullptr) expect("A", *A, square * square, n);
  const std::span tangent(A != nullptr ? A->data : nullptr, A != nullptr ? n * square * square : 0);
  last_ = points_.answer({P.data, n * square}, GRAINLAW_WANT_TANGENT_EXACT, tangent);
  return last_.summary.failed;
}

void PointSet::consolidate(const Array& sigma, const Array& reached, const std::string& route,
                           double overconsolidation) {
  const std::size_t n = points_.size();
  const auto square = static_cast<std::size_t>(dimension() * dimension());
  expect("sigma", sigma, square, n);
  expect("the stress that is reached", reached, square, n);
  grainlaw_consolidation how = grainlaw_consolidation_default();
  how.route = route_named(route);
  how.overconsolidation = overconsolidation;
  std::vector<std::size_t> all(n);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const auto led =
      points_.consolidate(all, {sigma.data, n * square}, how, {reached.data, n * square});
  if (!led) throw std::runtime_error(led.message());
  last_ = {};
}

void PointSet::set_time_step(double step) {
  const grainlaw_status status = grainlaw_points_set_time_step(points_.get(), step);
  if (status == GRAINLAW_BAD_ARGUMENT)
    throw std::invalid_argument("the time step is " + std::to_string(step) +
                                ", expected a number of at least 0");
  check(status);
}

void PointSet::commit() {
  const grainlaw_status status = grainlaw_points_commit(points_.get());
  if (status == GRAINLAW_NO_TRIAL)
    throw std::logic_error(last_ ? "there is nothing to commit, expected an evaluation before"
                                 : "the last evaluation found no equilibrium; revert, and cut the "
                                   "step (" +
                                       last_.message() + ")");
  check(status);
}

void PointSet::revert() { points_.revert(); }

void PointSet::save(const std::string& path) const {
  const std::vector<std::byte> bytes = points_.save();
  grainlaw::adapters::WholeFile file(path);
  file.write(bytes.data(), bytes.size());
  file.keep();
}

void PointSet::load(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::runtime_error(path + ": cannot be read");
  const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad()) throw std::runtime_error(path + ": cannot be read");
  try {
    points_.load(std::as_bytes(std::span(bytes)));
  } catch (const grainlaw::StatusError& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  last_ = {};
}

void PointSet::measure(const std::string& name, const Array& values) const {
  if (points_.size() == 0) return;
  const std::vector<double> found = points_.measure(measure_named(name));
  expect("the array of values", values, found.size() / points_.size(), points_.size());
  std::copy(found.begin(), found.end(), values.data);
}

void PointSet::write_vtk(long point, const std::string& path) const {
  if (point < 0 || point >= size())
    throw std::invalid_argument("there is no point " + std::to_string(point) + ", expected 0 to " +
                                std::to_string(size() - 1));
  const grainlaw_status status = grainlaw_state_write_vtk(
      grainlaw_points_state(points_.get(), static_cast<std::size_t>(point)), path.c_str());
  check(status, path + ": " + grainlaw_status_text(status));
}

}  // namespace grainlaw_freefem
