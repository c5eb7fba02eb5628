// A host in small, after the public headers of MGIS (BehaviourDataView.hxx, StateView.hxx,
// LibrariesManager.cxx; behaviour API version 1). It loads a behaviour library by dlopen, and keeps
// arrays at the start and the end of a step for many points. It never says commit to the behaviour.
#pragma once

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace grainlaw::test {

// The structs as the headers of MFront and MGIS document them, without those of this project.
struct mfront_gb_State {
  const double* gradients;
  double* thermodynamic_forces;
  const double* mass_density;
  const double* material_properties;
  double* internal_state_variables;
  double* stored_energy;
  double* dissipated_energy;
  const double* external_state_variables;
};
struct mfront_gb_BehaviourData {
  char* error_message;
  double dt;
  double* K;
  double* rdt;
  double* speed_of_sound;
  mfront_gb_State s0;
  mfront_gb_State s1;
};
static_assert(offsetof(mfront_gb_BehaviourData, K) == 16);
static_assert(offsetof(mfront_gb_BehaviourData, s0) == 40);
static_assert(sizeof(mfront_gb_BehaviourData) == 168);

class BehaviourLibrary {
 public:
  explicit BehaviourLibrary(const std::string& path) : handle_(dlopen(path.c_str(), RTLD_NOW)) {
    if (handle_ == nullptr) throw std::runtime_error(dlerror());
  }
  ~BehaviourLibrary() { dlclose(handle_); }
  BehaviourLibrary(const BehaviourLibrary&) = delete;
  BehaviourLibrary& operator=(const BehaviourLibrary&) = delete;

  template <class T>
  T* symbol(const std::string& name) const {
    void* address = dlsym(handle_, name.c_str());
    if (address == nullptr) throw std::runtime_error("there is no symbol " + name);
    T* typed;
    static_assert(sizeof typed == sizeof address);
    std::memcpy(&typed, &address, sizeof typed);
    return typed;
  }

 private:
  void* handle_;
};

enum Stress { cauchy, second_piola, first_piola };
enum Tangent { dsigma_dF, dS_dE, dP_dF, dtau_ddF };
constexpr double no_tangent = 0, elastic = 1, consistent = 4;

inline constexpr std::array<std::size_t, 9> tensor_order{0, 4, 8, 1, 3, 2, 6, 5, 7};

// Arrays for n points, as MaterialDataManager holds them.
class Manager {
 public:
  Manager(const BehaviourLibrary& library, const std::string& behaviour,
          const std::string& hypothesis, std::size_t n, Stress stress, Tangent tangent)
      : integrate_(library.symbol<int(mfront_gb_BehaviourData*)>(behaviour + "_" + hypothesis)),
        stress_(stress),
        tangent_(tangent),
        tensor(hypothesis == "PlaneStrain" ? 5 : 9),
        symmetric(hypothesis == "PlaneStrain" ? 4 : 6),
        stress_size(stress == first_piola ? tensor : symmetric),
        tangent_size((tangent == dP_dF ? tensor : symmetric) *
                     (tangent == dS_dE ? symmetric : tensor)),
        size(n) {
    for (auto* state : {&s0, &s1}) {
      state->gradients.assign(n * tensor, 0);
      state->forces.assign(n * stress_size, 0);
      state->internal.assign(n * 2, 0);
      for (std::size_t point = 0; point < n; ++point) {
        std::fill_n(&state->gradients[point * tensor], 3, 1.0);
      }
    }
    K.assign(n * tangent_size, 0);
  }

  void set_F(std::size_t point, const std::array<double, 4>& F) {
    double* gradient = &s1.gradients[point * tensor];
    gradient[0] = F[0];
    gradient[1] = F[3];
    gradient[2] = 1;
    gradient[3] = F[1];
    gradient[4] = F[2];
  }
  // Row by row; in plane strain what is out of the plane is left out.
  void set_F_in_space(std::size_t point, const std::array<double, 9>& F) {
    for (std::size_t k = 0; k < tensor; ++k) s1.gradients[point * tensor + k] = F[tensor_order[k]];
  }

  // One point; what the behaviour returns. message and rdt are set as by MGIS.
  int integrate(std::size_t point, double request = consistent) {
    std::array<char, 512> text{};
    double step = 1;
    const int result = call(point, request, text.data(), &step);
    message = text.data();
    rdt = step;
    return result;
  }

  int call(std::size_t point, double request, char* text, double* step) {
    double options[3];  // without a tangent MGIS hands over these alone
    mfront_gb_BehaviourData data{};
    data.error_message = text;
    data.dt = dt;
    data.rdt = step;
    data.K = request == no_tangent ? options : &K[point * tangent_size];
    data.K[0] = request;
    data.K[1] = stress_;
    data.K[2] = tangent_;
    data.s0 = view(s0, point);
    data.s1 = view(s1, point);
    return integrate_(&data);
  }

  void update() { s0 = s1; }
  void revert() { s1 = s0; }

  struct State {
    std::vector<double> gradients, forces, internal;
  };

 private:
  int (*integrate_)(mfront_gb_BehaviourData*);
  Stress stress_;
  Tangent tangent_;

  mfront_gb_State view(State& state, std::size_t point) const {
    mfront_gb_State result{};
    result.gradients = &state.gradients[point * tensor];
    result.thermodynamic_forces = &state.forces[point * stress_size];
    result.internal_state_variables = &state.internal[point * 2];
    result.mass_density = &zero_;
    result.external_state_variables = &zero_;
    return result;
  }
  double zero_ = 0;

 public:
  std::size_t tensor, symmetric, stress_size, tangent_size, size;
  State s0, s1;
  std::vector<double> K;
  std::string message;
  double dt = 1;  // of the step
  double rdt = 1;
};

}  // namespace grainlaw::test
