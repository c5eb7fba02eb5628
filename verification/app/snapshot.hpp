// Particles and contacts of a state as the library writes them, and what is drawn and counted from
// them.
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

  [[nodiscard]] double length() const {  // of the branch [m]
    return branch[2] == 0 ? std::hypot(branch[0], branch[1])
                          : std::hypot(branch[0], branch[1], branch[2]);
  }
};

struct Snapshot {
  std::vector<double> x, y, radius;  // [m]
  std::vector<double> rotation;  // since F = I [rad]; of spheres the length of the rotation vector
  std::vector<int> boundary;     // of a frame: particles in order around it; else empty
  std::vector<double> cell;      // H, row-major [m]
  std::vector<SnapshotContact> contacts;
  std::vector<double> z{};  // of spheres [m]

  [[nodiscard]] std::size_t size() const { return radius.size(); }
  [[nodiscard]] bool spheres() const { return !z.empty(); }
};

// The trial of a state, or the committed one without a trial. Throws ComputationError.
Snapshot take_snapshot(const grainlaw_state* state);

// Mean over the touching contacts of overlap / mean radius of the two (Liu, Bosco & Suiker 2017,
// eq. 39) [-].
double normalised_overlap(const Snapshot& snapshot);

// Mean over all particles, boundary included, of |rotation| (eq. 41) [rad].
double mean_rotation_magnitude(const Snapshot& snapshot);

// One panel of a row of pictures.
struct SnapshotPanel {
  std::string title;
  Snapshot snapshot;
};

// stem.svg and stem.png: discs, the frame and force chains, side by side at one scale. A bar between
// two centres is as wide as a mean radius when it carries `force` [N]; 0: four times the mean normal
// force of the panel where that is largest. Bonded contacts have another colour than frictional ones.
// Spheres are seen along y, without contacts that carry less than the mean, and with twelve times the mean.
bool draw_snapshots(const std::vector<SnapshotPanel>& panels, double force,
                    const std::string& title, const std::filesystem::path& stem);

}  // namespace verification
