// Stress error against CPU time of increments of spheres, beside YADE.
#include "evidence/studies/spheres/spheres.hpp"

#include "evidence/studies/statistics.hpp"

#include "app/cpu_time.hpp"
#include "app/progress.hpp"
#include "app/table.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace verification::spheres {
namespace {

constexpr int particles = 500;
constexpr int increments = 20;
constexpr double exactly = 1e-11;  // tolerance of what errors are measured against [-]

// YADE's 500 spheres.
grainlaw::Material reference(const StudyOptions& options, double tolerance, double viscous_number) {
  return grainlaw::Material::parse(
      fmt::format(R"(dimension = 3
[packing]
particles = "spheres500_particles.csv"
contacts = "spheres500_contacts.csv"
cell = "spheres500_cell.csv"
[contact]
law = "frictional"
young = 1e8
ratio = 0.8
friction = 0.5463024898437905
[solver]
tolerance = {}
viscous_number = {}
)",
                  tolerance, viscous_number),
      options.scene("../../tests/data/spheres500.toml").parent_path().string());
}

// F after so many increments, which need not be whole.
Tensor3 isochoric(double number) {
  const double axial = 1 - increment * number;
  const double lateral = 1 / std::sqrt(axial);
  return {lateral, 0, 0, 0, lateral, 0, 0, 0, axial};
}
Tensor3 triaxial(double number) { return deformation_after(number); }
Tensor3 shear(double number) { return deformation_after(number, true); }

struct Path {
  const char* name;
  Tensor3 (*deformation)(double number);
};
constexpr std::array<Path, 3> paths{
    {{"isochoric", isochoric}, {"triaxial", triaxial}, {"shear", shear}}};

// What an increment takes in YADE 2023.02a, by its stress error. As used: damping 0.1, whole step, to
// an unbalanced force of 1e-3. Best setting found: damping 0.5, ramp of 30 steps. `bar` is what its
// time over ours should be, `least` on each path.
struct Peer {
  const char* setting;
  double error;
  int steps;
  bool tangent;  // ours with the exact tangent
  double bar, least;
};
constexpr std::array<Peer, 3> peers{{{"as used", 4e-5, 340, false, 40, 35},
                                     {"best setting", 2.5e-4, 70, false, 9, 8},
                                     {"to 1e-8", 1e-8, 6180, true, 80, 70}}};

double difference(const Tensor3& P, const Tensor3& right) {
  double error = 0;
  double size = 0;
  for (std::size_t m = 0; m < 9; ++m) {
    error += std::pow(P[m] - right[m], 2);
    size += std::pow(right[m], 2);
  }
  return std::sqrt(error / size);
}

// Stresses after each increment, and the states before it.
struct Lead {
  std::vector<Tensor3> stress;
  std::vector<std::vector<std::byte>> before;
};

Lead lead_along(const grainlaw::Material& material, const Path& path, int parts) {
  grainlaw::State state(material);
  Lead lead;
  for (int k = 1; k <= increments; ++k) {
    lead.before.push_back(state.save());
    Tensor3 P{};
    for (int part = 1; part <= parts; ++part) {
      const Tensor3 F = path.deformation(k - 1 + static_cast<double>(part) / parts);
      if (state.evaluate(F, P).status != GRAINLAW_OK) return lead;
      state.commit();
    }
    lead.stress.push_back(P);
  }
  return lead;
}

struct Measured {
  std::vector<double> error, off_path;  // against equilibrium, and against the finer path [-]
  std::vector<double> cpu, cpu_exact;   // [ms]

  void add(const Measured& other) {
    const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(error, other.error);
    append(off_path, other.off_path);
    append(cpu, other.cpu);
    append(cpu_exact, other.cpu_exact);
  }
};

Measured measure(const grainlaw::Material& material, const Path& path, const Lead& start,
                 const Lead& equilibrium, const Lead& finer) {
  grainlaw::State state(material);
  Measured measured;
  for (std::size_t k = 0; k < start.stress.size() && k < equilibrium.stress.size(); ++k) {
    state.load(start.before[k]);
    const Tensor3 F = path.deformation(static_cast<double>(k + 1));
    Tensor3 P{};
    Tangent3 A{};
    const double begin = cpu_seconds();
    if (state.evaluate(F, P).status != GRAINLAW_OK) break;
    const double between = cpu_seconds();
    if (state.evaluate(F, P, GRAINLAW_WANT_TANGENT_EXACT, A).status != GRAINLAW_OK) break;
    measured.cpu_exact.push_back(1e3 * (cpu_seconds() - between));
    measured.cpu.push_back(1e3 * (between - begin));
    measured.error.push_back(difference(P, equilibrium.stress[k]));
    if (k < finer.stress.size()) measured.off_path.push_back(difference(P, finer.stress[k]));
  }
  return measured;
}

// Our least time at an error as small as the peer's [ms]; 0: none is.
double time_at(const std::vector<Measured>& by_tolerance, const Peer& peer) {
  double least = 0;
  for (const Measured& measured : by_tolerance) {
    if (median(measured.error) > peer.error) continue;
    const double cpu = median(peer.tangent ? measured.cpu_exact : measured.cpu);
    if (least == 0 || cpu < least) least = cpu;
  }
  return least;
}

}  // namespace

void measure_error(const StudyOptions& options, int seed, double yade_step, int finer_parts) {
  constexpr std::array<double, 10> tolerances{1e-2, 3e-3, 2e-3, 1e-3, 5e-4,
                                              3e-4, 2e-4, 1e-4, 1e-6, 1e-8};
  constexpr std::array<double, 2> numbers{0, 1e-3};
  const auto spheres = [&](double tolerance, double number) {
    return seed == 0 ? reference(options, tolerance, number)
                     : packed(particles, number, tolerance, seed);
  };
  Table table(
      fmt::format("increments of 0.1 % of 500 spheres{}, {} of each path, from "
                  "states solved to {:g}; stress errors against equilibrium at the same F "
                  "from the same start (with drag from equilibrium on the whole path), and "
                  "against a path of equilibria in increments {} times finer",
                  seed == 0 ? " of YADE's" : fmt::format(" compacted with seed {}", seed),
                  increments, exactly, finer_parts),
      {"path", "viscous_number[-]", "tolerance[-]", "error[-]", "off_finer_path[-]",
       "cpu_median[ms]", "cpu_mean[ms]", "with_tangent_median[ms]", "with_tangent_mean[ms]"});
  std::array<std::vector<Measured>, paths.size() + 1> equilibria;  // by tolerance; the last: all
  equilibria.back().resize(tolerances.size());
  Progress progress("spheres, error");
  double done = 0;
  for (std::size_t p = 0; p < paths.size(); ++p) {
    const auto exact = spheres(exactly, 0);
    const Lead equilibrium = lead_along(exact, paths[p], 1);
    const Lead finer = finer_parts > 0 ? lead_along(exact, paths[p], finer_parts) : Lead{};
    for (const double number : numbers) {
      const Lead own = number > 0 ? lead_along(spheres(exactly, number), paths[p], 1) : equilibrium;
      for (std::size_t t = 0; t < tolerances.size(); ++t) {
        progress.update(done++ / (paths.size() * numbers.size() * tolerances.size()),
                        paths[p].name);
        const auto material = spheres(tolerances[t], number);
        const Measured measured = measure(material, paths[p], own, equilibrium, finer);
        table.row({paths[p].name, fmt::format("{:g}", number), fmt::format("{:g}", tolerances[t]),
                   median(measured.error), median(measured.off_path), median(measured.cpu),
                   average(measured.cpu), median(measured.cpu_exact), average(measured.cpu_exact)});
        if (number > 0) continue;
        equilibria[p].push_back(measured);
        equilibria.back()[t].add(measured);
      }
    }
  }
  const std::string of = seed == 0 ? "" : fmt::format("_{}", seed);
  table.write(std::filesystem::path(options.output) / fmt::format("study_spheres_error{}.csv", of));
  table.print();

  Table verdict(
      fmt::format("YADE's time over ours at an error against equilibrium as small, "
                  "medians; a step of YADE takes {:.0f} ns a sphere, and it takes as many as on "
                  "its own packing",
                  yade_step),
      {"path", "yade_setting", "error[-]", "yade[ms]", "our_cpu[ms]", "ratio[-]", "bar[-]", "met"});
  for (std::size_t p = 0; p < equilibria.size(); ++p) {
    const bool all = p == paths.size();
    for (const Peer& peer : peers) {
      const double theirs = 1e-6 * yade_step * particles * peer.steps;
      const double ours = time_at(equilibria[p], peer);
      const double ratio = ours > 0 ? theirs / ours : 0;
      const double bar = all ? peer.bar : peer.least;
      verdict.row({all ? "all" : paths[p].name, peer.setting, peer.error, theirs, ours, ratio, bar,
                   ratio >= bar ? "yes" : "no"});
    }
  }
  verdict.write(std::filesystem::path(options.output) /
                fmt::format("study_spheres_yade{}.csv", of));
  verdict.print();
}

}  // namespace verification::spheres
