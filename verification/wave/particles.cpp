// Particles of a wave run: from a material to the rows of a table.

#include "app/interrupt.hpp"
#include "app/progress.hpp"
#include "base/error.hpp"
#include "dynamics/motion.hpp"
#include "wave/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace verification {

using grainlaw::core::Error;
using grainlaw::core::WaveEnergy;
using grainlaw::core::WaveMotion;
using grainlaw::core::WaveSpecimen;

namespace {

[[noreturn]] void fail(const Error& error, const std::string& text) {
  if (error.status > 0) throw ComputationError(text);
  throw InputError(text);
}

// Runs an action and translates errors of src/dynamics into errors of the program.
template <class Action>
decltype(auto) translated(Action&& action) {
  try {
    return action();
  } catch (const Error& error) {
    fail(error, error.what());
  }
}

std::shared_ptr<const grainlaw::core::Material<2>> inner_material(const MaterialSource& source) {
  const MaterialText description = material_text(source);
  try {
    return grainlaw::core::material_of_discs(description.text, description.base,
                                             description.origin);
  } catch (const Error& error) {
    std::string told = error.what();
    // Without the line, which is that of a text that nobody has.
    if (told.starts_with(description.origin + ":"))
      told.erase(0, told.find(": ", description.origin.size()) + 2);
    fail(error,
         fmt::format("{}: {} ({})", description.origin, told, grainlaw_status_text(error.status)));
  }
}

// Particles between two distances from the right end.
std::vector<std::size_t> particles_in(const WaveSpecimen& specimen, double from, double to) {
  const double end = specimen.right_end();
  std::vector<std::size_t> found;
  for (std::size_t p = 0; p < specimen.size(); ++p) {
    const double distance = end - specimen.position[p];
    if (distance >= from && distance <= to) found.push_back(p);
  }
  return found;
}

class Gauges {
 public:
  Gauges(const WaveSpecimen& specimen, const WaveCase& one) : specimen_(&specimen) {
    const double half = specimen.mean_radius();
    for (const double distance : one.sections) {
      sections_.push_back(particles_in(specimen, distance - half, distance + half));
      if (sections_.back().empty())
        throw InputError(
            fmt::format("{}: sections: found {} m, where no particle is; expected a "
                        "distance from the right end within the length of {:.4g} m",
                        one.name, distance, specimen.length));
    }
    for (const auto& [from, to] : one.windows) {
      if (to > specimen.length)
        throw InputError(
            fmt::format("{}: window.to: found {} m, expected at most the length of {:.4g} m",
                        one.name, to, specimen.length));
      std::vector<std::size_t> top;
      for (const std::size_t p : particles_in(specimen, from, to))
        if ((specimen.side[p] & 2) != 0) top.push_back(p);
      windows_.push_back({top, (to - from) * specimen.thickness});
    }
  }

  // Reads mass-weighted means over cross-sections, and forces on the top supports.
  void read(const WaveMotion& motion, WaveRow& row) const {
    for (const auto& section : sections_) {
      double mass = 0, sum = 0;
      for (const std::size_t p : section) {
        mass += specimen_->mass[p];
        sum -= specimen_->mass[p] * motion.displacement(p);
      }
      row.displacement.push_back(sum / mass);
    }
    if (windows_.empty()) return;
    const std::vector<double> vertical = motion.vertical_forces();
    for (const auto& [particles, area] : windows_) {
      double force = 0;
      for (const std::size_t p : particles) force -= vertical[p];
      row.stress.push_back(force / area);
    }
  }

 private:
  struct Window {
    std::vector<std::size_t> particles;
    double area;
  };
  const WaveSpecimen* specimen_;
  std::vector<std::vector<std::size_t>> sections_;
  std::vector<Window> windows_;
};

}  // namespace

WaveDomain wave_domain(const WaveCase& one) {
  const auto material = inner_material(one.material);
  const auto& h = material->packing.cell;
  return {h[0] * static_cast<double>(one.repeat),
          h[3],
          material->packing.thickness,
          grainlaw::core::mean_density(*material),
          material->space.reference_volume,
          material->packing.size()};
}

WaveRun run_particles(const WaveCase& one) {
  const auto material = inner_material(one.material);
  const WaveSpecimen specimen =
      translated([&] { return grainlaw::core::repeat_along_x(*material, one.repeat); });
  const Gauges gauges(specimen, one);
  const double slice = 4 * specimen.mean_radius();
  WaveMotion motion =
      translated([&] { return WaveMotion(specimen, material->law, one.time_step); });
  translated([&] { motion.settle(); });
  motion.damp({one.agitation_damping, slice});
  WaveRun run;
  run.name = "dns";
  run.particles = specimen.size();
  run.time_step = one.time_step;
  run.steps = std::lround(std::ceil(one.duration / one.time_step - 1e-9));
  const RowClock clock(run.steps, one.rows);
  const double at_rest = motion.energy(slice).stored;
  Progress progress(one.name + ", particles");
  const long steps = std::exchange(run.steps, 0);
  lead_wave(run, [&] {
    for (long step = 0; step <= steps; ++step) {
      if (step < steps) Interrupt::check();
      const double time = static_cast<double>(step) * one.time_step;
      if (step > 0) translated([&] { motion.step(-one.pulse.at(time)); });
      run.steps = step;
      if (!clock.due(step)) continue;
      WaveRow row;
      row.time = time;
      row.end = one.pulse.at(time);
      gauges.read(motion, row);
      const WaveEnergy energy = motion.energy(slice);
      row.work = energy.work;
      row.kinetic = energy.kinetic;
      row.coherent = energy.coherent;
      row.stored = energy.stored - at_rest;
      row.dissipated = energy.dissipated;
      row.contacts = motion.touching();
      run.rows.push_back(row);
      progress.update(static_cast<double>(step) / static_cast<double>(steps),
                      fmt::format("{:.2f} ms", 1e3 * time));
    }
  });
  return run;
}

}  // namespace verification
