// The five packings of figure 6: how coordination is counted, and which boundary discs T can load.

#include "evidence/papers/liu2017_boundary/boundary.hpp"
#include "pack/written.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace verification {
namespace {

constexpr std::array<int, 5> sizes{37, 120, 228, 444, 650};

struct Counts {
  double particles = 0;     // of the frame
  double fraction = 0;      // volume of discs / volume [-]
  double anisotropy = 0;    // of the contacts [-]
  double copies_once = 0;   // coordination, as the library measures it [-]
  double no_rattlers = 0;   // the same without rattlers [-]
  double as_drawn = 0;      // 2 C / N over all discs of the frame, copies as discs of their own [-]
  double inner = 0;         // mean number of contacts of the discs inside the frame [-]
  int boundary = 0;         // discs on the frame
  int without_contact = 0;  // of them without a contact within it
  int spare = 0;            // contact forces and stresses less equations of equilibrium under T
};

Counts count(const WrittenPacking& packing) {
  Counts counts;
  const std::size_t size = packing.radius.size();
  std::vector<int> contacts(size, 0);
  for (const WrittenContact& c : packing.contacts) ++contacts[c.i], ++contacts[c.j];
  std::vector<char> framed(size, 0);
  for (const std::size_t p : packing.boundary) {
    framed[p] = 1;
    counts.without_contact += contacts[p] == 0 ? 1 : 0;
  }
  // The unknowns are two components per contact and four of P; every disc has three equations. The
  // sums of these are the balance of the whole: P12 = P21, and two that hold in any case. Inner
  // rattlers take no part.
  counts.spare = static_cast<int>(2 * packing.contacts.size()) + 6;
  for (std::size_t p = 0; p < size; ++p) counts.spare -= contacts[p] > 0 || framed[p] ? 3 : 0;
  counts.particles = static_cast<double>(size);
  counts.boundary = static_cast<int>(packing.boundary.size());
  for (std::size_t p = 0; p < size; ++p) {
    counts.as_drawn += contacts[p] / static_cast<double>(size);
    if (!framed[p])
      counts.inner += contacts[p] / static_cast<double>(size - packing.boundary.size());
  }
  return counts;
}

MaterialSource recipe(const PaperStudy& study, int size) {
  MaterialSource source;
  source.file = study.scenes / fmt::format("pack_{}.toml", size);
  source.base = study.scenes;
  return source;
}

// Counts the packing that the material starts from.
Counts made(const PaperStudy& study, const MaterialSource& source) {
  State state(make_material(source));
  const std::string prefix = (study.results / "counted").string();
  check(grainlaw_state_write_packing(state.get(), prefix.c_str()), "writing a packing");
  Counts counts = count(read_written(prefix));
  counts.fraction = 1 / (1 + measure_scalar(state.get(), GRAINLAW_VOID_RATIO));
  counts.anisotropy = measure_scalar(state.get(), GRAINLAW_ANISOTROPY);
  counts.copies_once = measure_scalar(state.get(), GRAINLAW_COORDINATION);
  counts.no_rattlers = measure_scalar(state.get(), GRAINLAW_COORDINATION_NO_RATTLERS);
  for (const char* end : {"_particles.csv", "_contacts.csv", "_cell.csv"})
    std::filesystem::remove(prefix + end);
  return counts;
}

// By least squares.
double slope(const std::vector<std::pair<double, double>>& points) {
  const auto count = static_cast<double>(points.size());
  double x = 0, y = 0, xy = 0, xx = 0;
  for (const auto& [u, v] : points) x += u / count, y += v / count;
  for (const auto& [u, v] : points) xy += (u - x) * (v - y), xx += (u - x) * (u - x);
  return xy / xx;
}

void coordination(PaperStudy& study) {
  // sigma t / kn of the thesis over sigma R / kn of the paper.
  const PaperUnits units = read_units(study.scenes / "pack_650.toml");
  study.facts.add("packings.thickness_over_radius", units.thickness / units.mean_radius);
  Table table("Coordination by how it is counted",
              {"made", "packing[-]", "volume_fraction[-]", "copies_once[-]",
               "copies_once_no_rattlers[-]", "inner_discs[-]", "all_discs_of_the_frame[-]"});
  std::vector<std::pair<double, double>> anisotropy;  // logarithms of particles and anisotropy
  for (const bool rough : {false, true}) {
    double low = INFINITY, high = 0, loosest = 1, densest = 0;
    for (const int size : sizes) {
      MaterialSource source = recipe(study, size);
      if (rough) change(source, "packing", "friction", 0.4);
      const Counts c = made(study, source);
      table.row({rough ? "with friction 0.4" : "without friction", fmt::format("{}", size),
                 c.fraction, c.copies_once, c.no_rattlers, c.inner, c.as_drawn});
      if (!rough) {
        study.facts.add(fmt::format("packings.{}.particles", size), c.particles);
        anisotropy.emplace_back(std::log(c.particles), std::log(c.anisotropy));
      }
      low = std::min(low, c.as_drawn), high = std::max(high, c.as_drawn);
      loosest = std::min(loosest, c.fraction), densest = std::max(densest, c.fraction);
    }
    const char* made = rough ? "rough" : "smooth";
    study.facts.add(fmt::format("packings.{}.coordination_least", made), low);
    study.facts.add(fmt::format("packings.{}.coordination_most", made), high);
    study.facts.add(fmt::format("packings.{}.fraction_least", made), loosest);
    study.facts.add(fmt::format("packings.{}.fraction_most", made), densest);
  }
  study.facts.add("packings.anisotropy_power", slope(anisotropy));
  table.print();
  table.write(study.results / "coordination.csv");
}

// Why T finds no equilibrium: the recipes at rising initial pressure.
void uniform_stress_at_rest(const PaperStudy& study) {
  Table table("T at F = I", {"packing[-]", "seed[-]", "initial_pressure[kPa]", "boundary_discs[-]",
                             "of_them_without_contact[-]", "contacts_per_disc_of_the_frame[-]",
                             "spare_forces_per_disc[-]", "end"});
  const auto row = [&](int size, long seed, double pressure) {
    MaterialSource source = recipe(study, size);
    change(source, "packing", "pressure", 1e3 * pressure);
    change(source, "packing", "seed", seed);
    const Counts c = made(study, source);
    change(source, "boundary", "type", "frame-t");
    std::string end = "equilibrium";
    try {
      make_material(source);
    } catch (const ComputationError& error) {
      end = error.what();
      const std::size_t colon = end.find("at F = I: ");
      if (colon != std::string::npos) end = end.substr(colon + 10);
      end = end.substr(0, end.find(';'));
    }
    table.row({fmt::format("{}", size), static_cast<double>(seed), pressure,
               static_cast<double>(c.boundary), static_cast<double>(c.without_contact), c.as_drawn,
               c.spare / c.particles, end});
  };
  for (const double pressure : {1.0, 3.0, 10.0, 20.0, 30.0, 50.0, 100.0}) row(37, 14, pressure);
  for (long seed = 1; seed <= 16; ++seed) row(37, seed, 10);
  for (const auto& [size, seed] : {std::pair{120, 38L}, {228, 30L}, {444, 4L}, {650, 16L}})
    row(size, seed, 10);
  table.print();
  table.write(study.results / "uniform_stress_at_rest.csv");
}

}  // namespace

void study_packings(PaperStudy& study) {
  coordination(study);
  uniform_stress_at_rest(study);
}

}  // namespace verification
