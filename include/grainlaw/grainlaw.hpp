// grainlaw for C++20 hosts: owners of the C handles, spans for arrays, exceptions for faults.
// Header only; it calls grainlaw.h alone, whose conventions (row-major, SI, tension positive) hold
// here too.
#ifndef GRAINLAW_GRAINLAW_HPP
#define GRAINLAW_GRAINLAW_HPP

#include <grainlaw/grainlaw.h>

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace grainlaw {

// A status < 0, or a material that could not be created.
class StatusError : public std::runtime_error {
 public:
  StatusError(grainlaw_status status, const std::string& message)
      : std::runtime_error(message.empty() ? grainlaw_status_text(status) : message),
        status_(status) {}
  [[nodiscard]] grainlaw_status status() const { return status_; }

 private:
  grainlaw_status status_;
};

// Throws StatusError unless the status is OK.
inline void check(grainlaw_status status, const std::string& message = {}) {
  if (status != GRAINLAW_OK) throw StatusError(status, message);
}

class Material {
 public:
  // Call grainlaw_material_load or _parse. Throw StatusError with the library's message.
  static Material load(const std::string& path) {
    return create([&](grainlaw_material** out, char* message, std::size_t size) {
      return grainlaw_material_load(path.c_str(), out, message, size);
    });
  }
  static Material parse(const std::string& toml_text, const std::string& base_directory) {
    return create([&](grainlaw_material** out, char* message, std::size_t size) {
      return grainlaw_material_parse(toml_text.c_str(), base_directory.c_str(), out, message, size);
    });
  }

  [[nodiscard]] int dimension() const { return grainlaw_material_dimension(get()); }
  [[nodiscard]] const grainlaw_material* get() const { return handle_.get(); }

 private:
  struct Destroy {
    void operator()(grainlaw_material* handle) const { grainlaw_material_destroy(handle); }
  };

  template <class Call>
  static Material create(Call&& call) {
    std::array<char, 1024> message{};
    grainlaw_material* handle = nullptr;
    const grainlaw_status status = call(&handle, message.data(), message.size());
    check(status, message.data());
    Material material;
    material.handle_.reset(handle);
    return material;
  }

  Material() = default;
  std::unique_ptr<grainlaw_material, Destroy> handle_;
};

// Result of an evaluation. A recoverable failure is an answer, not a fault: retry with a step
// smaller by report.step_ratio.
struct Evaluation {
  grainlaw_status status = GRAINLAW_OK;
  grainlaw_report report = grainlaw_report_default();
  explicit operator bool() const { return status == GRAINLAW_OK; }
};

// One integration point. A copy is an independent state.
class State {
 public:
  explicit State(const Material& material) : dimension_(material.dimension()) {
    grainlaw_state* handle = nullptr;
    check(grainlaw_state_create(material.get(), &handle));
    handle_.reset(handle);
  }
  State(const State& other) : dimension_(other.dimension_) {
    grainlaw_state* handle = nullptr;
    check(grainlaw_state_clone(other.get(), &handle));
    handle_.reset(handle);
  }
  State(State&&) noexcept = default;
  State& operator=(State other) noexcept {
    handle_ = std::move(other.handle_);
    dimension_ = other.dimension_;
    return *this;
  }
  ~State() = default;

  // Evaluate F[dim*dim]; P[dim*dim] or empty, A[dim^4] or empty; want is 0 or one of
  // GRAINLAW_WANT_*. Throws StatusError for a status < 0 and for spans of another size.
  [[nodiscard]] Evaluation evaluate(std::span<const double> F, std::span<double> P,
                                    unsigned want = 0, std::span<double> A = {}) {
    const auto square = static_cast<std::size_t>(dimension_ * dimension_);
    if (F.size() != square || (!P.empty() && P.size() != square) ||
        (!A.empty() && A.size() != square * square))
      throw StatusError(GRAINLAW_BAD_ARGUMENT, "F, P need dim^2 numbers and A dim^4");
    Evaluation result;
    result.status = grainlaw_evaluate(get(), F.data(), want, P.empty() ? nullptr : P.data(),
                                      A.empty() ? nullptr : A.data(), &result.report);
    if (result.status < 0) throw StatusError(result.status, result.report.message);
    return result;
  }

  void set_time_step(double step) { check(grainlaw_state_set_time_step(get(), step)); }
  void commit() { check(grainlaw_commit(get())); }
  void revert() { check(grainlaw_revert(get())); }

  // Save the committed state to bytes, or load it. Throw StatusError.
  [[nodiscard]] std::vector<std::byte> save() const {
    std::size_t size = 0;
    check(grainlaw_state_save(get(), nullptr, &size));
    std::vector<std::byte> bytes(size);
    check(grainlaw_state_save(get(), bytes.data(), &size));
    return bytes;
  }
  void load(std::span<const std::byte> bytes) {
    check(grainlaw_state_load(get(), bytes.data(), bytes.size()));
  }

  // All components of a measure, in the unit of GRAINLAW_MEASURE_LIST.
  [[nodiscard]] std::vector<double> measure(grainlaw_measure what) const {
    std::size_t count = 0;
    check(grainlaw_state_measure(get(), what, nullptr, &count));
    std::vector<double> value(count);
    check(grainlaw_state_measure(get(), what, value.data(), &count));
    return value;
  }

  // Particles and contacts of the trial, or of the committed state without a trial.
  [[nodiscard]] std::vector<grainlaw_particle> particles() const {
    return list<grainlaw_particle>(grainlaw_state_particles);
  }
  [[nodiscard]] std::vector<grainlaw_contact> contacts() const {
    return list<grainlaw_contact>(grainlaw_state_contacts);
  }

  void write_vtk(const std::string& path) const {
    check(grainlaw_state_write_vtk(get(), path.c_str()));
  }
  void write_packing(const std::string& prefix) const {
    check(grainlaw_state_write_packing(get(), prefix.c_str()));
  }

  // Handle for C functions, e.g. grainlaw_evaluate_batch.
  [[nodiscard]] grainlaw_state* get() const { return handle_.get(); }

 private:
  template <class Record, class Function>
  [[nodiscard]] std::vector<Record> list(Function* function) const {
    std::size_t count = 0;
    check(function(get(), nullptr, sizeof(Record), &count));
    std::vector<Record> records(count);
    check(function(get(), records.data(), sizeof(Record), &count));
    return records;
  }

  struct Destroy {
    void operator()(grainlaw_state* handle) const { grainlaw_state_destroy(handle); }
  };
  std::unique_ptr<grainlaw_state, Destroy> handle_;
  int dimension_;
};

// Result of an evaluation of a set. A recoverable failure is an answer.
struct PointsEvaluation {
  grainlaw_status status = GRAINLAW_OK;  // of the first failed point
  grainlaw_summary summary = grainlaw_summary_default();
  explicit operator bool() const { return status == GRAINLAW_OK; }

  // "point 3: reason"; "" when none failed.
  [[nodiscard]] std::string message() const {
    if (summary.failed == 0) return summary.message;
    return "point " + std::to_string(summary.first_failed) + ": " + summary.message;
  }
};

// The integration points of one material, numbered from 0. A copy is an independent set.
class Points {
 public:
  Points(const Material& material, std::size_t count) : dimension_(material.dimension()) {
    grainlaw_points* handle = nullptr;
    check(grainlaw_points_create(material.get(), count, &handle));
    handle_.reset(handle);
  }
  Points(const Points& other) : dimension_(other.dimension_) {
    grainlaw_points* handle = nullptr;
    check(grainlaw_points_clone(other.get(), &handle));
    handle_.reset(handle);
  }
  Points(Points&&) noexcept = default;
  Points& operator=(Points other) noexcept {
    handle_ = std::move(other.handle_);
    dimension_ = other.dimension_;
    return *this;
  }
  ~Points() = default;

  [[nodiscard]] std::size_t size() const { return grainlaw_points_size(get()); }
  [[nodiscard]] int dimension() const { return dimension_; }

  // Evaluate F[n*dim*dim]; P[n*dim*dim], A[n*dim^4], status[n], reports[n] of
  // grainlaw_report_default may be empty. threads <= 0: the library's default. Throws StatusError,
  // whose text names the point, for a status < 0, and for spans of another size.
  [[nodiscard]] PointsEvaluation evaluate(std::span<const double> F, std::span<double> P,
                                          unsigned want = 0, std::span<double> A = {},
                                          int threads = 0, std::span<grainlaw_status> status = {},
                                          std::span<grainlaw_report> reports = {}) {
    const auto square = static_cast<std::size_t>(dimension_ * dimension_);
    const std::size_t n = size();
    const auto fits = [](std::size_t found, std::size_t need) {
      return found == 0 || found == need;
    };
    if (F.size() != n * square || !fits(P.size(), n * square) ||
        !fits(A.size(), n * square * square) || !fits(status.size(), n) || !fits(reports.size(), n))
      throw StatusError(GRAINLAW_BAD_ARGUMENT,
                        "F, P need dim^2 numbers a point and A dim^4; status and reports one each");
    PointsEvaluation result;
    result.status =
        grainlaw_points_evaluate(get(), F.data(), want, given(P), given(A), given(status),
                                 given(reports), threads, &result.summary);
    if (result.status < 0) throw StatusError(result.status, result.message());
    return result;
  }

  // Act on all points; commit fails for all where one has no trial.
  void set_time_step(double step) { check(grainlaw_points_set_time_step(get(), step)); }
  void commit() { check(grainlaw_points_commit(get())); }
  void revert() { check(grainlaw_points_revert(get())); }

  // Save all committed states to bytes, or load all or none. Throw StatusError.
  [[nodiscard]] std::vector<std::byte> save() const {
    std::size_t size = 0;
    check(grainlaw_points_save(get(), nullptr, &size));
    std::vector<std::byte> bytes(size);
    check(grainlaw_points_save(get(), bytes.data(), &size));
    return bytes;
  }
  void load(std::span<const std::byte> bytes) {
    std::array<char, 256> message{};
    const grainlaw_status status =
        grainlaw_points_load(get(), bytes.data(), bytes.size(), message.data(), message.size());
    check(status, message.data());
  }

  // All components of a measure, by points.
  [[nodiscard]] std::vector<double> measure(grainlaw_measure what) const {
    std::size_t count = 0;
    check(grainlaw_points_measure(get(), what, nullptr, &count));
    std::vector<double> values(count);
    check(grainlaw_points_measure(get(), what, values.data(), &count));
    return values;
  }

  // State for C functions that read one, e.g. grainlaw_state_write_vtk; lives as long as the set.
  // Throws StatusError for a number outside the set.
  [[nodiscard]] const grainlaw_state* state(std::size_t point) const {
    const grainlaw_state* const found = grainlaw_points_state(get(), point);
    if (found == nullptr)
      throw StatusError(GRAINLAW_BAD_ARGUMENT, "there is no point " + std::to_string(point));
    return found;
  }

  [[nodiscard]] grainlaw_points* get() const { return handle_.get(); }

 private:
  struct Destroy {
    void operator()(grainlaw_points* handle) const { grainlaw_points_destroy(handle); }
  };
  template <class T>
  static T* given(std::span<T> all) {
    return all.empty() ? nullptr : all.data();
  }

  std::unique_ptr<grainlaw_points, Destroy> handle_;
  int dimension_;
};

}  // namespace grainlaw

#endif
