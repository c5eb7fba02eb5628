#include "evidence/studies/spheres/spheres.hpp"

#include "evidence/studies/statistics.hpp"

#include "app/cpu_time.hpp"
#include "app/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace verification::spheres {
namespace {

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

// What an increment takes with YADE 2023.02a on one core of a Zen 3 [ms], by its stress error: as it is used
// (damping 0.2, half the critical step), with the best setting found, and to 1e-8.
struct Peer {
  const char* name;
  double error, cpu;
};
constexpr std::array<Peer, 3> yade{
    {{"as used", 4e-5, 153}, {"best setting", 2.5e-4, 32}, {"to 1e-8", 1e-8, 2780}}};

}  // namespace

// Isochoric increments of 0.1 %, each from the state that was solved to 1e-11.
void measure_error(const StudyOptions& options) {
  constexpr int increments = 20;
  Table table(
      "stress error and CPU time of an increment of 500 spheres of YADE's, medians of 20 isochoric "
      "increments of 0.1 %; over YADE's time for an error as small, measured elsewhere",
      {"viscous_number[-]", "tolerance[-]", "stress_error[-]", "cpu[ms]", "cpu_with_tangent[ms]",
       "yade_as_used/cpu[-]", "yade_best/cpu[-]", "yade_1e-8/cpu_with_tangent[-]"});
  for (const double number : {0.0, 1e-3}) {
    const auto exact = reference(options, 1e-11, number);
    for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-6, 1e-8}) {
      const auto coarse = reference(options, tolerance, number);
      grainlaw::State lead(exact);
      grainlaw::State state(coarse);
      std::vector<double> errors, plain, with_tangent;
      for (int k = 1; k <= increments; ++k) {
        const double axial = 1 - increment * k;
        const double lateral = 1 / std::sqrt(axial);
        const Tensor3 F{lateral, 0, 0, 0, lateral, 0, 0, 0, axial};
        Tensor3 right{}, P{};
        Tangent3 A{};
        if (lead.evaluate(F, right).status != GRAINLAW_OK) break;
        const double start = cpu_seconds();
        if (state.evaluate(F, P).status != GRAINLAW_OK) break;
        const double between = cpu_seconds();
        if (state.evaluate(F, P, GRAINLAW_WANT_TANGENT_EXACT, A).status != GRAINLAW_OK) break;
        plain.push_back(1e3 * (between - start));
        with_tangent.push_back(1e3 * (cpu_seconds() - between));
        double error = 0;
        double size = 0;
        for (std::size_t m = 0; m < 9; ++m) {
          error += std::pow(P[m] - right[m], 2);
          size += std::pow(right[m], 2);
        }
        errors.push_back(std::sqrt(error / size));
        lead.commit();
        state.load(lead.save());
      }
      const double cpu = median(plain);
      const double exact_cpu = median(with_tangent);
      const double error = median(errors);
      const auto ratio = [&](const Peer& peer, double own) -> Table::Cell {
        if (error > peer.error && peer.error > 1e-8) return std::string{};
        if (peer.error <= 1e-8 && tolerance > 1e-8) return std::string{};
        return peer.cpu / own;
      };
      table.row({fmt::format("{:g}", number), fmt::format("{:g}", tolerance), error, cpu, exact_cpu,
                 ratio(yade[0], cpu), ratio(yade[1], cpu), ratio(yade[2], exact_cpu)});
    }
  }
  table.write(std::filesystem::path(options.output) / "study_spheres_error.csv");
  table.print();
}

}  // namespace verification::spheres
