// One call of an MGIS host: which state is meant, the packing's answer, in the host's measures.
#include "floating_environment.hpp"
#include "library_points.hpp"
#include "number_text.hpp"
#include "point_table.hpp"

#include <grainlaw/mgis.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>

namespace grainlaw::adapters {
namespace {

constexpr std::size_t message_size = 512;

constexpr std::array<std::size_t, 9> tensor_order{0, 4, 8, 1, 3, 2, 6, 5, 7};
constexpr std::array<std::size_t, 6> symmetric_order{0, 4, 8, 1, 2, 5};

// What K asks for on entry.
struct Request {
  bool prediction = false;  // tangent at the start of the step; no integration
  unsigned want = 0;
  int stress = 0;   // 0 Cauchy, 1 second, 2 first Piola-Kirchhoff
  int tangent = 0;  // 0 dsigma/dF, 1 dS/dE, 2 dP/dF, 3 dtau/d(dF)

  // Whether anything asked for exists for a symmetric stress alone.
  [[nodiscard]] bool symmetric() const {
    return (!prediction && stress != 2) || (want != 0 && tangent != 2);
  }
};

int option(double value, int most, const char* what) {
  if (!(value > -0.5 && value < most + 0.5)) {
    throw std::runtime_error(std::string(what) + " is " + shown(value) + "; 0 to " +
                             std::to_string(most) + " were expected");
  }
  return static_cast<int>(std::lround(value));
}

Request read_request(const double* K) {
  if (!(std::abs(K[0]) < 50)) {
    throw std::runtime_error(std::isfinite(K[0])
                                 ? "K[0] asks for the speed of sound, which is not computed"
                                 : "K[0], what is asked for, is not finite");
  }
  Request request;
  request.prediction = K[0] < -0.5;
  const double kind = std::abs(K[0]);
  if (kind > 2.5) {
    request.want = GRAINLAW_WANT_TANGENT_EXACT;
  } else if (kind > 0.5) {
    request.want = GRAINLAW_WANT_TANGENT_ELASTIC;
  }
  request.stress = option(K[1], 2, "K[1], the stress measure,");
  if (request.want != 0) request.tangent = option(K[2], 3, "K[2], the tangent,");
  return request;
}

Tensor2 read_gradient(const double* values, int dimension) {
  Tensor2 F = identity;
  const std::size_t size = dimension == 2 ? 5 : 9;
  for (std::size_t k = 0; k < size; ++k) F[tensor_order[k]] = values[k];
  return F;
}

// Sizes and factors of the host's vectors: row a of a symmetric tensor carries sqrt(2) from 12 on.
double factor(bool symmetric, std::size_t a) {
  return symmetric && a >= 3 ? std::numbers::sqrt2 : 1;
}
std::size_t size_of(bool symmetric, int dimension) {
  if (symmetric) return dimension == 2 ? 4 : 6;
  return dimension == 2 ? 5 : 9;
}
std::size_t place(bool symmetric, std::size_t a) {
  return symmetric ? symmetric_order[a] : tensor_order[a];
}

void write_stress(const Request& request, int dimension, const Response& response, double* out) {
  const bool symmetric = request.stress != 2;
  const Tensor2 stress = request.stress == 0   ? cauchy_stress(response)
                         : request.stress == 1 ? second_piola_stress(response)
                                               : response.P;
  for (std::size_t a = 0; a < size_of(symmetric, dimension); ++a) {
    out[a] = factor(symmetric, a) * stress[place(symmetric, a)];
  }
}

void write_tangent(const Request& request, int dimension, const Response& response,
                   const Tensor2& F0, double* K) {
  Tensor4 computed;
  const Tensor4* tangent = &computed;
  if (request.tangent == 0) {
    cauchy_by_F(response, computed);
  } else if (request.tangent == 1) {
    second_piola_by_green(response, computed);
  } else if (request.tangent == 2) {
    tangent = &response.A;
  } else {
    kirchhoff_by_increment(response, F0, computed);
  }
  const bool rows = request.tangent != 2;
  const bool columns = request.tangent == 1;
  for (std::size_t a = 0; a < size_of(rows, dimension); ++a) {
    const double* row = &(*tangent)[9 * place(rows, a)];
    for (std::size_t b = 0; b < size_of(columns, dimension); ++b) {
      *K++ = factor(rows, a) * factor(columns, b) * row[place(columns, b)];
    }
  }
}

// Releases a new point when the call ends: the host's next one names it by what it was answered.
class NotKept {
 public:
  NotKept(grainlaw::Table& table, long long name) : table_(table), name_(name) {}
  ~NotKept() { static_cast<void>(grainlaw_table_forget(table_.get(), name_, 0)); }
  NotKept(const NotKept&) = delete;
  NotKept& operator=(const NotKept&) = delete;

 private:
  grainlaw::Table& table_;
  long long name_;
};

// Asks the host for a shorter step, as a march takes it after this suggestion of a point.
void shorten(const grainlaw_mgis_data& data, double step_ratio) {
  if (data.rdt != nullptr) *data.rdt = std::min(*data.rdt, grainlaw_march_cut(step_ratio));
}

void require(const void* pointer, const char* what) {
  if (pointer == nullptr) throw std::runtime_error(std::string(what) + " is a null pointer");
}

int integrate(PointTable& points, int dimension, grainlaw_mgis_data& data) {
  require(data.K, "K");
  require(data.s0.gradients, "s0.gradients");
  require(data.s0.internal_state_variables, "s0.internal_state_variables");
  const Request request = read_request(data.K);
  if (!request.prediction) {
    require(data.s1.gradients, "s1.gradients");
    require(data.s1.thermodynamic_forces, "s1.thermodynamic_forces");
    require(data.s1.internal_state_variables, "s1.internal_state_variables");
  }
  grainlaw::Table& table = points.table();
  if (table.dimension() > dimension) {
    throw std::runtime_error("a packing of spheres needs the hypothesis Tridimensional");
  }
  const double* const internal = data.s0.internal_state_variables;
  const bool is_new = internal[0] == 0 && internal[1] == 0;
  const double time_step = time_step_of(data.dt);
  const Tensor2 F0 = is_new ? identity : read_gradient(data.s0.gradients, dimension);
  const long long name =
      is_new ? points.create(time_step) : points.find(internal[0], internal[1], F0);
  std::optional<NotKept> not_kept;
  if (is_new) not_kept.emplace(table, name);
  double token = internal[1];
  const Tensor2 F = request.prediction ? F0 : read_gradient(data.s1.gradients, dimension);
  const PointCall call{
      name,      0,           &token, is_new ? nullptr : &F0, request.prediction ? nullptr : &F,
      time_step, request.want};
  Response response;
  const Answer answer = request.symmetric() ? evaluate_symmetric(table, call, response)
                                            : evaluate(table, call, response);
  if (answer.status != GRAINLAW_OK) {
    if (answer.status > 0) shorten(data, answer.report.step_ratio);
    throw std::runtime_error(std::string(grainlaw_status_text(answer.status)) +
                             (answer.report.message[0] != '\0' ? ": " : "") +
                             answer.report.message);
  }
  if (request.want != 0) write_tangent(request, dimension, response, F0, data.K);
  if (request.prediction) return 1;
  write_stress(request, dimension, response, data.s1.thermodynamic_forces);
  data.s1.internal_state_variables[0] = static_cast<double>(name);
  data.s1.internal_state_variables[1] = token;
  if (!answer.approximate) return 1;
  shorten(data, 1);
  if (data.error_message != nullptr) {
    std::snprintf(data.error_message, message_size,
                  "the equilibrium was only found by advancing the friction history; approximate");
  }
  return 0;
}

}  // namespace
}  // namespace grainlaw::adapters

extern "C" {

int grainlaw_mgis_integrate(grainlaw_mgis_behaviour* behaviour, int dimension,
                            grainlaw_mgis_data* data) {
  using namespace grainlaw::adapters;
  const FloatingEnvironment environment;
  if (behaviour == nullptr || data == nullptr) return -1;
  const auto tell = [&](const char* what) {
    if (data->error_message != nullptr) {
      std::snprintf(data->error_message, message_size, "%s: %s", behaviour->name, what);
    }
    return -1;
  };
  try {
    return integrate(points_of<PointTable>(behaviour), dimension, *data);
  } catch (const std::exception& error) {
    return tell(error.what());
  } catch (...) {
    return tell("unknown fault");
  }
}

size_t grainlaw_mgis_states(const grainlaw_mgis_behaviour* behaviour) {
  if (behaviour == nullptr || behaviour->points == nullptr) return 0;
  return static_cast<const grainlaw::adapters::PointTable*>(behaviour->points)->size();
}

void grainlaw_mgis_release(grainlaw_mgis_behaviour* behaviour) {
  grainlaw::adapters::release_points<grainlaw::adapters::PointTable>(behaviour);
}

}  // extern "C"
