// Static direct simulation: the library applied to a whole specimen, with boundary rules on its
// four sides.
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

// End and cost of a run.
struct SpecimenEnd {
  int particles = 0;
  int boundary = 0;  // particles on the boundary
  int steps = 0;
  int steps_wanted = 0;
  Record start;               // under the initial stress
  Effort effort;              // sum over the steps
  double cpu = 0;             // of the thread, without output [s]
  double elapsed = 0;         // [s]
  std::string text = "done";  // reason of the end
};

// A specimen of repeated frames. Prescribed components of P are a uniform stress on sides with rule
// "T", and the library finds their components of F.
class Specimen {
 public:
  // Called after every step, and at the start.
  using Observer = std::function<void(const grainlaw_state*, const Record&)>;

  // Builds the frame, repeats it and writes stem_specimen_particles.csv, _contacts.csv and
  // _cell.csv. Throws InputError for a wrong scene, ComputationError without an equilibrium.
  Specimen(const SpecimenScene& scene, const std::filesystem::path& stem);

  // Runs all segments. The result tells of an early end; one by Interrupted from an observer is
  // stored in `stopped`. Throws InputError.
  SpecimenEnd run(const Observer& observe, const CutObserver& observe_cut,
                  std::exception_ptr& stopped);
  SpecimenEnd run(const Observer& observe) {
    std::exception_ptr stopped;
    return run(observe, {}, stopped);
  }

 private:
  using Stresses = std::array<std::optional<double>, 4>;  // prescribed components of P [Pa]
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
  MaterialSource source_;  // the specimen with a boundary free of stress
  Stresses prescribed_;
  std::optional<State> state_;
  double volume_ = 0;  // at F = I [m3]
  Tensor deformation_ = Tensor::Identity();
  Evaluation evaluation_;
  Record record_;
  SpecimenEnd end_;
};

}  // namespace verification
