// Particles and contacts of a state, with their pictures and counts.
#pragma once

#include "app/library.hpp"

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace verification {

struct SnapshotContact {
  int i = 0;
  int j = 0;
  std::array<double, 3> branch{};  // from the centre of i to that of j or of its image [m]
  double normal_force = 0;         // [N], compression positive
  bool bonded = false;

  [[nodiscard]] double length() const {  // length of the branch [m]
    return branch[2] == 0 ? std::hypot(branch[0], branch[1])
                          : std::hypot(branch[0], branch[1], branch[2]);
  }
};

struct Snapshot {
  std::vector<double> x, y, radius;   // [m]
  std::vector<double> rotation;       // since F = I [rad]; spheres: length of the rotation vector
  std::vector<std::size_t> boundary;  // particles of a frame in order; else empty
  std::vector<double> cell;           // H, row-major [m]
  std::vector<SnapshotContact> contacts;
  std::vector<double> z{};  // of spheres [m]

  [[nodiscard]] std::size_t size() const { return radius.size(); }
  [[nodiscard]] bool spheres() const { return !z.empty(); }
};

// Takes a snapshot of the trial, or of the committed state without a trial. Throws ComputationError.
Snapshot take_snapshot(const grainlaw_state* state);

// Mean over touching contacts of overlap / mean radius of the pair (Liu, Bosco & Suiker 2017, eq.
// 39) [-].
double normalised_overlap(const Snapshot& snapshot);

// Mean over all particles, boundary included, of |rotation| (eq. 41) [rad].
double mean_rotation_magnitude(const Snapshot& snapshot);

struct SnapshotPanel {
  std::string title;
  Snapshot snapshot;
};

// Draws stem.svg and stem.png: discs, frame and force chains, side by side at one scale. A bar is
// one mean radius wide at `force` [N]; 0: at four times the largest mean normal force of a panel.
// Bonded and frictional contacts have different colours. Spheres are seen along y, without contacts
// below the mean force, and with twelve times the mean.
bool draw_snapshots(const std::vector<SnapshotPanel>& panels, double force,
                    const std::string& title, const std::filesystem::path& stem);

}  // namespace verification
