// Static direct simulation: the library's own particle engine on a whole specimen, with boundary
// spaces on its four sides.
#pragma once

#include "app/library.hpp"
#include "app/parts.hpp"
#include "app/record.hpp"
#include "dns/scene.hpp"

#include <exception>
#include <filesystem>
#include <functional>
#include <string>

namespace verification {

// How far a run went and what it cost.
struct SpecimenEnd {
  int particles = 0;
  int boundary = 0;  // of them
  int steps = 0;
  int steps_wanted = 0;
  Record start;               // under the stress of the start
  Effort effort;              // sum over the steps
  double cpu = 0;             // of the thread, output left out [s]
  double elapsed = 0;         // [s]
  std::string text = "done";  // why it ended
};

// A specimen of repeated frames. Components of P that a segment prescribes are a uniform stress on
// the sides whose rule is "T", and the library finds the components of F that belong to them.
class Specimen {
 public:
  // Called after every step, and once at the start.
  using Observer = std::function<void(const grainlaw_state*, const Record&)>;

  // Makes the frame, repeats it and writes stem_specimen_particles.csv, _contacts.csv and _cell.csv.
  // Throws InputError for a wrong scene, ComputationError when there is no equilibrium.
  Specimen(const SpecimenScene& scene, const std::filesystem::path& stem);

  // All segments. A path that ends early is told in the result; so is one that an observer ends by
  // Interrupted, which is left in `stopped`. Throws InputError.
  SpecimenEnd run(const Observer& observe, const CutObserver& observe_cut,
                  std::exception_ptr& stopped);
  SpecimenEnd run(const Observer& observe) {
    std::exception_ptr stopped;
    return run(observe, {}, stopped);
  }

 private:
  using Stresses = std::array<std::optional<double>, 4>;  // P that is prescribed [Pa]
  struct Goal {
    Tensor deformation;
    Stresses stress;
  };

  void prescribe(const Stresses& stress);
  void bring_to_start();
  [[nodiscard]] Goal goal_at(const SpecimenSegment& segment, const Tensor& deformation,
                             const Tensor& stress, double fraction) const;
  void step(const SpecimenSegment& segment, const Tensor& deformation, const Tensor& stress,
            double from, double to, int number, const CutObserver& observe_cut);
  void accept(const Evaluation& evaluation);

  SpecimenScene scene_;
  MaterialSource source_;  // the specimen, its boundary without stress
  Stresses prescribed_;
  std::optional<State> state_;
  double volume_ = 0;  // at F = I [m3]
  Tensor deformation_ = Tensor::Identity();
  Evaluation evaluation_;
  Record record_;
  SpecimenEnd end_;
};

}  // namespace verification
