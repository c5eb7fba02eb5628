// Results of a wave run, for particles and meshes.
#pragma once

#include "wave/scene.hpp"

#include <chrono>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

namespace verification {

// Processor and elapsed time since construction.
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
  std::vector<double> stress;        // normal to the top in the windows, tension positive [Pa]
  double work = 0;                   // by the right end [J]
  double kinetic = 0;                // [J]
  double coherent = 0;               // kinetic energy of the mean motion of cross-sections, of the
                                     // nodes of a mesh [J]
  double stored = 0;                 // in contacts, relative to the start [J]
  double dissipated = 0;             // by friction, broken bonds, damping; meshes: what is left [J]
  double contacts = 0;               // touching contacts; meshes: mean per point
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
  std::exception_ptr stopped;  // error or Interrupted; rows are those before

  // ": " and what interrupted the run; empty otherwise. An error is told by who catches it.
  [[nodiscard]] std::string reason() const;
};

// Calls lead() and stores the exception that ends it early.
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

// Runs the particles (dynamics/motion.hpp), built from the material's representative volumes.
WaveRun run_particles(const WaveCase& one);

// Data of the particles' specimen that a mesh needs.
struct WaveDomain {
  double length = 0, height = 0, thickness = 0;  // [m]
  double density = 0;                            // [kg/m3]
  double volume = 0;                             // of one representative volume [m3]
  std::size_t particles = 0;                     // per representative volume
};
WaveDomain wave_domain(const WaveCase& one);

// Runs finite elements, `divisions` along x and one over the height (wave_mesh.cpp).
WaveRun run_mesh(const WaveCase& one, const WaveDomain& domain, int divisions);

// Clock of table rows: the steps nearest to an even division of time.
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

// Difference of the displacements at section k from those of `run`, over the amplitude.
struct WaveError {
  double largest = 0, mean_square = 0;  // [-]; mean_square is the root of the mean square
};
WaveError difference(const WaveRun& run, const WaveRun& reference, std::size_t section,
                     double amplitude);

}  // namespace verification
