// Stands in for CalculiX 2.20: calls a material function as nonlingeo.c, resultsmech.f and
// call_external_umat_user.c do, in an order taken down from the solver.
//   - An increment starts with a call at the predicted F, where PNEWDT is not looked at.
//   - Each iteration makes one call; PNEWDT > 0 there cuts the increment, which starts again from
//     the same F0.
//   - An accepted increment ends with a call at the same F for the stress alone (icmd = 3).
//   - The next one starts from the F of that call.
#pragma once

#include <dlfcn.h>

#include <array>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace grainlaw::test {

using F2 = std::array<double, 4>;  // F11 F12 F21 F22

using UserMaterial = void(const char*, const int*, const int*, const int*, const double*,
                          const double*, const double*, const double*, const double*, const double*,
                          const double*, const double*, const int*, const double*, const double*,
                          const double*, const double*, const int*, const int*, const int*,
                          const int*, const double*, double*, double*, double*, const int*,
                          const double*, const double*, double*, const int*, int);

class MaterialLibrary {
 public:
  explicit MaterialLibrary(const std::string& path) : handle_(dlopen(path.c_str(), RTLD_NOW)) {
    if (handle_ == nullptr) throw std::runtime_error(dlerror());
  }
  ~MaterialLibrary() { dlclose(handle_); }
  MaterialLibrary(const MaterialLibrary&) = delete;
  MaterialLibrary& operator=(const MaterialLibrary&) = delete;

  UserMaterial* function(const std::string& name) const {
    void* address = dlsym(handle_, name.c_str());
    if (address == nullptr) throw std::runtime_error("there is no function " + name);
    UserMaterial* typed;
    std::memcpy(&typed, &address, sizeof typed);
    return typed;
  }

 private:
  void* handle_;
};

inline std::array<double, 9> columns(const F2& F) {
  return {F[0], F[2], 0, F[1], F[3], 0, 0, 0, 1};
}

// A point of an element.
class Host {
 public:
  Host(UserMaterial* material, int element, int point)
      : material_(material), element_(element), point_(point) {}

  // One call at the end of the increment; whether it may go on.
  bool call(const std::array<double, 9>& F1, bool stress_only = false) {
    const int one = 1, none = 0, command = stress_only ? 3 : 0, constants = -101, points = 8;
    const double zero[9]{};
    double state = 0;
    pnewdt = -1;
    material_("@GRAIN_SAND", &element_, &point_, &constants, zero, zero, zero, zero, F0.data(),
              zero, F1.data(), zero, &none, zero, &dtime, &dtime, zero, &command, &none, &points,
              &none, &state, &state, stress.data(), stiffness.data(), &none, zero, zero, &pnewdt,
              &one, 80);
    ++calls;
    return !(pnewdt > 0);
  }

  // An increment through some iterates to the last; false when it has to be cut.
  bool increment(const std::vector<F2>& iterates) {
    call(columns(iterates.front()));
    for (const F2& F : iterates) {
      if (!call(columns(F))) return false;
    }
    call(columns(iterates.back()), true);
    F0 = columns(iterates.back());
    return true;
  }

  std::array<double, 9> F0{1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<double, 6> stress{};
  std::array<double, 21> stiffness{};
  double pnewdt = -1;
  double dtime = 1;
  int calls = 0;

 private:
  UserMaterial* material_;
  int element_, point_;
};

}  // namespace grainlaw::test
