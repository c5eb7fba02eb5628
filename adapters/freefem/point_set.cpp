#include "point_set.hpp"

#include "whole_file.hpp"

#include <algorithm>
#include <cctype>
#include <climits>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace grainlaw_freefem {
namespace {

using grainlaw::abi::check;

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

// A file of states: this text, the number of points, then size and bytes of each.
constexpr char file_head[] = "grainlaw points 1\n";

void write_number(grainlaw::adapters::WholeFile& file, std::uint64_t number) {
  file.write(&number, sizeof number);
}

std::uint64_t read_number(std::istream& stream) {
  std::uint64_t number = 0;
  stream.read(reinterpret_cast<char*>(&number), sizeof number);
  return number;
}

}  // namespace

PointSet::PointSet(const std::string& material_path, long points) {
  if (points < 1)
    throw std::invalid_argument("the number of points is " + std::to_string(points) +
                                ", expected at least 1");
  const auto material = grainlaw::abi::Material::load(material_path);
  dimension_ = material.dimension();
  const auto n = static_cast<std::size_t>(points);
  states_.reserve(n);
  for (std::size_t k = 0; k < n; ++k) states_.emplace_back(material);
  collect_handles();
  status_.resize(n, GRAINLAW_OK);
  reports_.resize(n, grainlaw_report_default());
}

void PointSet::collect_handles() {
  handles_.clear();
  for (const grainlaw::abi::State& state : states_) handles_.push_back(state.get());
}

long PointSet::evaluate(const Array& F, const Array& P, const Array* A, long threads) {
  const std::size_t n = states_.size();
  const auto square = static_cast<std::size_t>(dimension_ * dimension_);
  expect("F", F, square, n);
  expect("P", P, square, n);
  if (A != nullptr) expect("A", *A, square * square, n);
  if (threads < 0 || threads > INT_MAX)
    throw std::invalid_argument("threads is " + std::to_string(threads) +
                                ", expected 0 (as many as the library takes) or a number of them");
  evaluated_ = false;
  failure_ = {};
  const unsigned want = A != nullptr ? unsigned{GRAINLAW_WANT_TANGENT_EXACT} : 0u;
  const grainlaw_status status = grainlaw_evaluate_batch(
      n, handles_.data(), F.data, want, P.data, A != nullptr ? A->data : nullptr, status_.data(),
      reports_.data(), static_cast<int>(threads));
  if (status == GRAINLAW_OK) {
    evaluated_ = true;
    return 0;
  }
  long failed = 0;
  for (std::size_t k = 0; k < n; ++k) {
    if (status_[k] == GRAINLAW_OK) continue;
    if (status_[k] < 0) {
      const std::string text = describe(k);
      revert();
      throw std::runtime_error(text);
    }
    if (failed++ == 0) {
      failure_.point = static_cast<long>(k);
      failure_.message = describe(k);
    }
    failure_.step_ratio = std::min(failure_.step_ratio, reports_[k].step_ratio);
  }
  if (failed == 0) check(status);  // of the call itself
  return failed;
}

std::string PointSet::describe(std::size_t point) const {
  const char* text = reports_[point].message;
  return "point " + std::to_string(point) + ": " +
         (text[0] != '\0' ? text : grainlaw_status_text(status_[point]));
}

void PointSet::commit() {
  if (!evaluated_)
    throw std::logic_error(
        failure_.point >= 0
            ? "the last evaluation found no equilibrium; revert, and cut the step (" +
                  failure_.message + ")"
            : "there is nothing to commit, expected an evaluation before");
  for (grainlaw_state* state : handles_) check(grainlaw_commit(state));
  evaluated_ = false;
}

void PointSet::revert() {
  evaluated_ = false;
  for (grainlaw_state* state : handles_) check(grainlaw_revert(state));
}

void PointSet::save(const std::string& path) const {
  grainlaw::adapters::WholeFile file(path);
  file.write(file_head, sizeof file_head);
  write_number(file, states_.size());
  for (const grainlaw::abi::State& state : states_) {
    const std::vector<std::byte> bytes = state.save();
    write_number(file, bytes.size());
    file.write(bytes.data(), bytes.size());
  }
  file.keep();
}

void PointSet::load(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::runtime_error(path + ": cannot be read");
  const std::uint64_t file_size = std::filesystem::file_size(path);
  char head[sizeof file_head] = {};
  stream.read(head, sizeof head);
  if (!stream || std::memcmp(head, file_head, sizeof head) != 0)
    throw std::runtime_error(path + ": this is not a file of grainlawSave");
  const std::uint64_t count = read_number(stream);
  if (!stream || count != states_.size())
    throw std::runtime_error(path + ": it holds " + std::to_string(count) + " points, expected " +
                             std::to_string(states_.size()));
  // Into copies first: either all points are read, or none is touched.
  std::vector<grainlaw::abi::State> read = states_;
  std::vector<std::byte> bytes;
  for (std::size_t k = 0; k < read.size(); ++k) {
    const std::uint64_t size = read_number(stream);
    if (!stream || size > file_size)
      throw std::runtime_error(path + ": it ends at point " + std::to_string(k));
    bytes.resize(size);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (!stream) throw std::runtime_error(path + ": it ends at point " + std::to_string(k));
    const grainlaw_status status = grainlaw_state_load(read[k].get(), bytes.data(), bytes.size());
    if (status != GRAINLAW_OK)
      throw std::runtime_error(path + ": point " + std::to_string(k) + ": " +
                               grainlaw_status_text(status));
  }
  states_ = std::move(read);
  collect_handles();
  evaluated_ = false;
  failure_ = {};
}

void PointSet::measure(const std::string& name, const Array& values) const {
  const grainlaw_measure what = measure_named(name);
  std::size_t components = 0;
  check(grainlaw_state_measure(handles_.front(), what, nullptr, &components));
  expect("the array of values", values, components, states_.size());
  for (std::size_t k = 0; k < handles_.size(); ++k) {
    std::size_t count = components;
    check(grainlaw_state_measure(handles_[k], what, values.data + k * components, &count));
  }
}

void PointSet::write_vtk(long point, const std::string& path) const {
  if (point < 0 || point >= size())
    throw std::invalid_argument("there is no point " + std::to_string(point) + ", expected 0 to " +
                                std::to_string(size() - 1));
  const grainlaw_status status =
      grainlaw_state_write_vtk(handles_[static_cast<std::size_t>(point)], path.c_str());
  check(status, path + ": " + grainlaw_status_text(status));
}

}  // namespace grainlaw_freefem
