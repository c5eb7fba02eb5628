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

// Bytes of a function like grainlaw_state_save.
template <class Handle>
std::vector<std::byte> saved_by(grainlaw_status save(const Handle*, void*, std::size_t*),
                                const Handle* handle) {
  std::size_t size = 0;
  check(save(handle, nullptr, &size));
  std::vector<std::byte> bytes(size);
  check(save(handle, bytes.data(), &size));
  return bytes;
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

  // The material that save() wrote. Throws StatusError with the library's message.
  static Material load_saved(std::span<const std::byte> bytes) {
    return create([&](grainlaw_material** out, char* message, std::size_t size) {
      return grainlaw_material_load_saved(bytes.data(), bytes.size(), out, message, size);
    });
  }

  [[nodiscard]] std::vector<std::byte> save() const {
    return saved_by(grainlaw_material_save, get());
  }
  // A number that two materials share if their bytes are the same.
  [[nodiscard]] unsigned long long fingerprint() const {
    unsigned long long found = 0;
    check(grainlaw_material_fingerprint(get(), &found));
    return found;
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
    return saved_by<grainlaw_state>(grainlaw_state_save, get());
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

  // "point 3: reason", in a shared set "rank 1, point 3: reason"; "" when none failed.
  [[nodiscard]] std::string message() const {
    const std::string rank = summary.rank < 0 ? ""
                                              : "rank " + std::to_string(summary.rank) +
                                                    (summary.failed > 0 ? ", " : ": ");
    if (summary.failed == 0) return rank + summary.message;
    return rank + "point " + std::to_string(summary.first_failed) + ": " + summary.message;
  }
};

// Bytes of some points: those of the k-th from offsets[k] to offsets[k + 1].
struct SavedPoints {
  std::vector<std::byte> bytes;
  std::vector<std::size_t> offsets{0};
};

// Integration points, numbered from 0. A copy is an independent set.
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
    if (F.size() != size() * square()) refuse_sizes();
    return evaluate_numbered(size(), nullptr, F, P, want, A, threads, status, reports);
  }

  // Evaluate the points of these numbers; F, P, A, status, reports by their order in `which`.
  [[nodiscard]] PointsEvaluation evaluate_some(std::span<const std::size_t> which,
                                               std::span<const double> F, std::span<double> P,
                                               unsigned want = 0, std::span<double> A = {},
                                               int threads = 0,
                                               std::span<grainlaw_status> status = {},
                                               std::span<grainlaw_report> reports = {}) {
    return evaluate_numbered(which.size(), which.data(), F, P, want, A, threads, status, reports);
  }

  // P[n*dim*dim] and A[n*dim^4], which may be empty, of the committed states without an increment.
  [[nodiscard]] PointsEvaluation answer(std::span<double> P, unsigned want = 0,
                                        std::span<double> A = {}, int threads = 0) {
    if (!fits(P.size(), size() * square()) || !fits(A.size(), size() * square() * square()))
      refuse_sizes();
    PointsEvaluation result;
    result.status =
        grainlaw_points_answer(get(), want, given(P), given(A), threads, &result.summary);
    if (result.status < 0) throw StatusError(result.status, result.message());
    return result;
  }

  // Processor time of the last evaluation of each point [s].
  [[nodiscard]] std::vector<double> cost() const {
    std::vector<double> seconds(size());
    check(grainlaw_points_cost(get(), seconds.data()));
    return seconds;
  }

  // Change the number of points; new ones are of the first material, or of this one.
  void resize(std::size_t count) { check(grainlaw_points_resize(get(), count, nullptr)); }
  void resize(std::size_t count, const Material& of_new) {
    check(grainlaw_points_resize(get(), count, of_new.get()));
  }

  // Copy points from[which_from[k]], committed and trial, to the points which_to[k].
  void clone_some(std::span<const std::size_t> which_to, const Points& from,
                  std::span<const std::size_t> which_from) {
    if (which_to.size() != which_from.size())
      throw StatusError(GRAINLAW_BAD_ARGUMENT, "as many points to copy as to copy to are needed");
    check(grainlaw_points_clone_some(get(), which_to.size(), which_to.data(), from.get(),
                                     which_from.data()));
  }

  // Share failures with other ranks; evaluations and commits are then calls of all ranks.
  void share(int rank, grainlaw_reduce reduce, void* context) {
    check(grainlaw_points_share(get(), rank, reduce, context));
  }
  // Throw on all ranks the error of the first one that tells a status; "" and OK: none here.
  void agree(grainlaw_status mine, const std::string& text) {
    std::array<char, 256> message{};
    text.copy(message.data(), message.size() - 1);
    const auto agreed = grainlaw_points_agree(get(), mine, message.data(), message.size());
    check(agreed, message.data());
  }

  // Lead the points `which` to the Cauchy stress sigma[n*dim*dim] and make that F = I, all or none.
  // reached[n*dim*dim], status[n] may be empty. Throws StatusError for a status < 0.
  [[nodiscard]] PointsEvaluation consolidate(
      std::span<const std::size_t> which, std::span<const double> sigma,
      const grainlaw_consolidation& how = grainlaw_consolidation_default(),
      std::span<double> reached = {}, int threads = 0, std::span<grainlaw_status> status = {}) {
    if (sigma.size() != which.size() * square() || !fits(reached.size(), sigma.size()) ||
        !fits(status.size(), which.size()))
      refuse_sizes();
    PointsEvaluation result;
    result.status =
        grainlaw_points_consolidate(get(), which.size(), which.data(), sigma.data(), &how,
                                    given(reached), given(status), threads, &result.summary);
    if (result.status < 0) throw StatusError(result.status, result.message());
    return result;
  }

  // Act on all points; commit fails for all where one has no trial.
  void set_time_step(double step) { check(grainlaw_points_set_time_step(get(), step)); }
  void commit() { check(grainlaw_points_commit(get())); }
  void revert() { check(grainlaw_points_revert(get())); }

  // Save all committed states to bytes, or load all or none. Throw StatusError.
  [[nodiscard]] std::vector<std::byte> save() const {
    return saved_by<grainlaw_points>(grainlaw_points_save, get());
  }
  void load(std::span<const std::byte> bytes) {
    std::array<char, 256> message{};
    const grainlaw_status status =
        grainlaw_points_load(get(), bytes.data(), bytes.size(), message.data(), message.size());
    check(status, message.data());
  }

  // Save some committed states to bytes, or load some, all or none. Throw StatusError.
  [[nodiscard]] SavedPoints save_some(std::span<const std::size_t> which) const {
    SavedPoints saved;
    saved.offsets.resize(which.size() + 1);
    const auto save = [&](void* bytes) {
      check(grainlaw_points_save_some(get(), which.size(), which.data(), bytes,
                                      saved.offsets.data()));
    };
    if (which.empty()) return saved;
    save(nullptr);
    saved.bytes.resize(saved.offsets.back());
    save(saved.bytes.data());
    return saved;
  }
  void load_some(std::span<const std::size_t> which, const SavedPoints& saved) {
    if (saved.offsets.size() != which.size() + 1 || saved.offsets.back() > saved.bytes.size())
      throw StatusError(GRAINLAW_BAD_ARGUMENT,
                        "offsets need one number more than there are points");
    std::array<char, 256> message{};
    const grainlaw_status status =
        grainlaw_points_load_some(get(), which.size(), which.data(), saved.bytes.data(),
                                  saved.offsets.data(), message.data(), message.size());
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
  static bool fits(std::size_t found, std::size_t need) { return found == 0 || found == need; }
  [[noreturn]] static void refuse_sizes() {
    throw StatusError(GRAINLAW_BAD_ARGUMENT,
                      "F, P need dim^2 numbers a point and A dim^4; status and reports one each");
  }
  [[nodiscard]] std::size_t square() const {
    return static_cast<std::size_t>(dimension_ * dimension_);
  }
  [[nodiscard]] PointsEvaluation evaluate_numbered(std::size_t n, const std::size_t* which,
                                                   std::span<const double> F, std::span<double> P,
                                                   unsigned want, std::span<double> A, int threads,
                                                   std::span<grainlaw_status> status,
                                                   std::span<grainlaw_report> reports) {
    if (F.size() != n * square() || !fits(P.size(), n * square()) ||
        !fits(A.size(), n * square() * square()) || !fits(status.size(), n) ||
        !fits(reports.size(), n))
      refuse_sizes();
    PointsEvaluation result;
    result.status =
        grainlaw_points_evaluate_some(get(), n, which, F.data(), 0, want, given(P), 0, given(A), 0,
                                      given(status), given(reports), threads, &result.summary);
    if (result.status < 0) throw StatusError(result.status, result.message());
    return result;
  }

  std::unique_ptr<grainlaw_points, Destroy> handle_;
  int dimension_;
};

// Points found by element and point, for a host that never says commit.
class Table {
 public:
  explicit Table(const Material& material) : dimension_(material.dimension()) {
    grainlaw_table* handle = nullptr;
    check(grainlaw_table_create(material.get(), &handle));
    handle_.reset(handle);
  }

  [[nodiscard]] std::size_t size() const { return grainlaw_table_size(get()); }
  [[nodiscard]] int dimension() const { return dimension_; }

  // Call grainlaw_table_evaluate, whose pointers are those of `call`. Throws StatusError for a
  // status < 0.
  struct Call {
    double* token = nullptr;
    const double* F0 = nullptr;
    const double* F = nullptr;
    double time_step = 0;
    unsigned want = 0;
    double* P = nullptr;
    double* A = nullptr;
  };
  [[nodiscard]] Evaluation evaluate(long long element, long long point, const Call& call) {
    Evaluation result;
    result.status =
        grainlaw_table_evaluate(get(), element, point, call.token, call.F0, call.F, call.time_step,
                                call.want, call.P, call.A, &result.report);
    if (result.status < 0) throw StatusError(result.status, result.report.message);
    return result;
  }

  // All components of a measure of a point. Throws StatusError for an unknown one.
  [[nodiscard]] std::vector<double> measure(long long element, long long point,
                                            grainlaw_measure what) const {
    std::size_t count = 0;
    check(grainlaw_table_measure(get(), element, point, what, nullptr, &count));
    std::vector<double> value(count);
    check(grainlaw_table_measure(get(), element, point, what, value.data(), &count));
    return value;
  }
  void forget(long long element, long long point) {
    check(grainlaw_table_forget(get(), element, point));
  }

  // Save all points with their tokens to bytes, or load all or none. Throw StatusError.
  [[nodiscard]] std::vector<std::byte> save() const {
    return saved_by<grainlaw_table>(grainlaw_table_save, get());
  }
  void load(std::span<const std::byte> bytes) {
    std::array<char, 256> message{};
    const grainlaw_status status =
        grainlaw_table_load(get(), bytes.data(), bytes.size(), message.data(), message.size());
    check(status, message.data());
  }

  [[nodiscard]] grainlaw_table* get() const { return handle_.get(); }

 private:
  struct Destroy {
    void operator()(grainlaw_table* handle) const { grainlaw_table_destroy(handle); }
  };
  std::unique_ptr<grainlaw_table, Destroy> handle_;
  int dimension_;
};

// A load step in parts: cut where it fails, longer again after it; see march.h.
class March {
 public:
  // The set, if any, has to outlive it.
  explicit March(Points* set = nullptr,
                 const grainlaw_march_options& options = grainlaw_march_options_default()) {
    grainlaw_march* handle = nullptr;
    check(grainlaw_march_create(&options, set == nullptr ? nullptr : set->get(), &handle));
    handle_.reset(handle);
  }

  void begin(double from, double to) { check(grainlaw_march_begin(get(), from, to)); }
  grainlaw_action next() { return grainlaw_march_next(get(), &part_); }
  // What the last next() told.
  [[nodiscard]] const grainlaw_part& part() const { return part_; }
  [[nodiscard]] double share(double largest_change) {
    return grainlaw_march_share(get(), largest_change);
  }

  // Tell the outcome of an evaluation, or of a host's own solver.
  void tell(const PointsEvaluation& found, double residual, double scale, double unforeseen = -1) {
    check(grainlaw_march_tell(get(), found.status, &found.summary, residual, scale, unforeseen));
  }
  void tell(grainlaw_status status, double residual = 0, double scale = 1, double unforeseen = -1) {
    check(grainlaw_march_tell(get(), status, nullptr, residual, scale, unforeseen));
  }

  [[nodiscard]] grainlaw_march* get() const { return handle_.get(); }

 private:
  struct Destroy {
    void operator()(grainlaw_march* handle) const { grainlaw_march_destroy(handle); }
  };
  std::unique_ptr<grainlaw_march, Destroy> handle_;
  grainlaw_part part_ = grainlaw_part_default();
};

}  // namespace grainlaw

#endif
