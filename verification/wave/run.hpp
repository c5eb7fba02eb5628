// What a wave run writes down, of particles and of meshes alike.
#pragma once

#include "wave/scene.hpp"

#include <chrono>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

namespace verification {

// Processor and elapsed time since it was made.
class CostClock {
 public:
  CostClock();
  [[nodiscard]] double cpu() const;   // of all threads [s]
  [[nodiscard]] double wall() const;  // [s]

 private:
  double cpu_;
  std::chrono::steady_clock::time_point start_;
};

struct WaveRow {
  double time = 0;                   // [s]
  double end = 0;                    // displacement of the right end, inwards [m]
  std::vector<double> displacement;  // at the sections, inwards [m]
  std::vector<double> stress;        // normal to the top, in the windows, tension positive [Pa]
  double work = 0;                   // done by the right end [J]
  double kinetic = 0;                // [J]
  double coherent = 0;               // of it, in the mean motion of cross-sections [J]
  double stored = 0;                 // in contacts, more than at the start [J]
  double dissipated = 0;  // by friction, broken bonds, damping; of meshes all but stored [J]
  double contacts = 0;    // that touch; of meshes the mean of a point
};

struct WaveRun {
  std::string name;  // "dns" or the number of elements
  std::size_t particles = 0, points = 0;
  long steps = 0;
  long cuts = 0;         // time steps that points refused
  double time_step = 0;  // [s]
  double cpu = 0;        // of all threads [s]
  double wall = 0;       // [s]
  std::vector<WaveRow> rows;
  std::exception_ptr stopped;  // by an error or Interrupted; the rows are those before

  // Why it was stopped, empty when it was not.
  [[nodiscard]] std::string reason() const;
};

// Calls lead(), and keeps what ends it early.
template <class Lead>
void lead_wave(WaveRun& run, Lead&& lead) {
  const CostClock cost;
  try {
    lead();
  } catch (...) {
    run.stopped = std::current_exception();
  }
  run.cpu = cost.cpu();
  run.wall = cost.wall();
}

// The particles (wave/motion.hpp), made of the material's representative volumes.
WaveRun run_particles(const WaveCase& one);

// What a mesh has to know of the particles' specimen.
struct WaveDomain {
  double length = 0, height = 0, thickness = 0;  // [m]
  double density = 0;                            // [kg/m3]
  double volume = 0;                             // of a representative volume [m3]
  std::size_t particles = 0;                     // in one
};
WaveDomain wave_domain(const WaveCase& one);

// Finite elements, `divisions` along x and one over the height (wave_mesh.cpp).
WaveRun run_mesh(const WaveCase& one, const WaveDomain& domain, int divisions);

// Times at which rows are written are step numbers nearest to an even division.
class RowClock {
 public:
  RowClock(long steps, std::size_t rows) : steps_(steps), rows_(static_cast<long>(rows)) {}
  [[nodiscard]] bool due(long step) const {
    return step * rows_ / steps_ != (step - 1) * rows_ / steps_ || step == 0;
  }

 private:
  long steps_, rows_;
};

void write_rows(const WaveRun& run, const WaveCase& one, const std::filesystem::path& path);

// Difference of displacements at section k, over the rows of `run`, relative to the amplitude.
struct WaveError {
  double largest = 0, mean_square = 0;  // [-]; the latter under the root
};
WaveError difference(const WaveRun& run, const WaveRun& reference, std::size_t section,
                     double amplitude);

}  // namespace verification
