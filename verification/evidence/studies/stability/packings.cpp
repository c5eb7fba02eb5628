#include "evidence/studies/stability/packings.hpp"

#include "app/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

namespace verification::stability {
namespace {

constexpr double mean_radius = 5e-3;  // [m]
constexpr double pressure = 100e3;    // [Pa]
constexpr double thickness = 0.1;     // [m]
// Beyond this kn / p it is the pressure that falls, not the modulus that rises [-].
constexpr double stiffest_modulus = 1e3;

void describe(const Contact& contact, int dimension, MaterialSource& source) {
  source.changes.insert_or_assign("dimension", dimension);
  change(source, "contact", "law", "frictional");
  change(source, "contact", "young", contact.young);
  change(source, "contact", "ratio", contact.ratio);
  change(source, "contact", "friction", contact.friction);
  change(source, "contact", "rotation", contact.rotation);
  change(source, "solver", "tolerance", contact.tolerance);
  if (contact.stress_free) change(source, "solver", "contacts_lost", "stress_free");
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream stream(path);
  stream << text;
  stream.close();
  if (!stream) throw ComputationError(fmt::format("{}: cannot be written", path.string()));
}

// Reads files that the library or write_tiny wrote.
TinyPacking read_tiny(const std::filesystem::path& prefix) {
  const CsvTable particles = read_csv(prefix.string() + "_particles.csv");
  const CsvTable cell = read_csv(prefix.string() + "_cell.csv");
  TinyPacking packing;
  for (std::size_t k = 0; k < particles.rows(); ++k)
    packing.discs.push_back({particles["x"][k], particles["y"][k], particles["r"][k]});
  packing.cell << cell["H00"][0], cell["H01"][0], cell["H10"][0], cell["H11"][0];
  packing.thickness = cell["thickness"][0];
  return packing;
}

void write_tiny(const std::filesystem::path& prefix, const TinyPacking& packing) {
  std::string text = "id,x,y,r\n";
  for (std::size_t k = 0; k < packing.discs.size(); ++k)
    text += fmt::format("{},{},{},{}\n", k, packing.discs[k].x, packing.discs[k].y,
                        packing.discs[k].radius);
  write(prefix.string() + "_particles.csv", text);
  const Tensor& h = packing.cell;
  write(prefix.string() + "_cell.csv",
        fmt::format("H00,H01,H10,H11,thickness\n{},{},{},{},{}\n", h(0, 0), h(0, 1), h(1, 0),
                    h(1, 1), packing.thickness));
}

// Distance from a place to the nearest surface of a disc or of its images [m].
double clearance(const TinyPacking& packing, double x, double y) {
  double least = std::numeric_limits<double>::infinity();
  for (const Disc& disc : packing.discs) {
    Eigen::Vector2d way(disc.x - x, disc.y - y);
    Eigen::Vector2d share = packing.cell.inverse() * way;
    share = share.unaryExpr([](double s) { return s - std::round(s); });
    way = packing.cell * share;
    least = std::min(least, way.norm() - disc.radius);
  }
  return least;
}

// Expands to the last equilibrium before contacts are lost.
template <int D>
void expand(State& state, double stiffness) {
  double stretch = 1;
  for (double step = 0.1 / stiffness; step > 1e-6 / stiffness;) {
    const TensorOf<D> deformation = (stretch + step) * TensorOf<D>::Identity();
    if (evaluate_of<D>(state, deformation, 0).status == GRAINLAW_OK) {
      state.commit();
      stretch += step;
    } else {
      step *= 0.5;
    }
  }
}

}  // namespace

double Recipe::young() const {
  const double of_one = dimension == 2 ? pressure * thickness / mean_radius : pressure;
  return std::min(stiffness, stiffest_modulus) * of_one;
}

Material PackingStore::make(const Recipe& recipe) {
  const double smallest = 2 * mean_radius / (1 + recipe.size_ratio);
  MaterialSource source;
  describe({.young = recipe.young(), .tolerance = 1e-8}, recipe.dimension, source);
  if (recipe.dimension == 2) source.changes.insert_or_assign("thickness", thickness);
  change(source, "packing", "generator", "compaction");
  change(source, "packing", "count", recipe.count);
  change(source, "packing", "radii", toml::array{smallest, smallest * recipe.size_ratio});
  change(source, "packing", "seed", recipe.seed);
  change(source, "packing", "pressure",
         pressure * std::min(1.0, stiffest_modulus / recipe.stiffness));
  return make_material(source, recipe.dimension);
}

std::string PackingStore::ensure(const Recipe& recipe) const {
  const std::string name = fmt::format("{}{}_stiffness{:g}_sizes{:.3g}_seed{}",
                                       recipe.dimension == 2 ? "discs" : "spheres", recipe.count,
                                       recipe.stiffness, recipe.size_ratio, recipe.seed);
  if (std::filesystem::exists(directory_ / (name + "_cell.csv"))) return name;
  std::filesystem::create_directories(directory_);
  State(make(recipe)).write_packing((directory_ / name).string());
  return name;
}

Material PackingStore::from_files(const std::string& name, const Contact& contact, bool with_forces,
                                  int dimension) const {
  MaterialSource source;
  source.base = directory_;
  describe(contact, dimension, source);
  change(source, "packing", "particles", name + "_particles.csv");
  change(source, "packing", "cell", name + "_cell.csv");
  if (with_forces) change(source, "packing", "contacts", name + "_contacts.csv");
  return made(std::move(source), dimension);
}

Material PackingStore::made(MaterialSource source, int dimension) const {
  if (viscous_number_ > 0) change(source, "solver", "viscous_number", viscous_number_);
  return make_material(source, dimension);
}

Material PackingStore::fcc(double overlap, const Contact& contact) const {
  MaterialSource source;
  describe(contact, 3, source);
  change(source, "packing", "generator", "fcc");
  change(source, "packing", "cells", toml::array{2, 2, 2});
  change(source, "packing", "radius", mean_radius);
  change(source, "packing", "overlap", overlap);
  return made(std::move(source), 3);
}

Material PackingStore::generated(const Recipe& recipe, Contact contact) const {
  contact.young = recipe.young();
  return from_files(ensure(recipe), contact, true, recipe.dimension);
}

Material PackingStore::with_rattler(const Recipe& recipe, Contact contact) const {
  contact.young = recipe.young();
  const std::string name = ensure(recipe);
  TinyPacking packing = read_tiny(directory_ / name);
  constexpr int nodes_per_side = 400;  // per side, in search of the widest void
  Disc rattler;
  for (int a = 0; a < nodes_per_side; ++a)
    for (int b = 0; b < nodes_per_side; ++b) {
      const Eigen::Vector2d at = packing.cell * Eigen::Vector2d(a, b) / nodes_per_side;
      const double radius = 0.5 * clearance(packing, at.x(), at.y());
      if (radius > rattler.radius) rattler = {at.x(), at.y(), radius};
    }
  packing.discs.push_back(rattler);
  return tiny(name + "_rattler", packing, contact);
}

Material PackingStore::barely_touching(const Recipe& recipe, Contact contact) const {
  contact.young = recipe.young();
  const std::string name = ensure(recipe) + "_barely_touching";
  // At equilibrium, as the packings of all cases.
  const Material tight = PackingStore(directory_).generated(recipe, contact);
  State state(tight);
  if (recipe.dimension == 2) {
    expand<2>(state, recipe.stiffness);
  } else {
    expand<3>(state, recipe.stiffness);
  }
  check(grainlaw_state_write_packing(state.get(), (directory_ / name).string().c_str()),
        "writing a packing");
  return from_files(name, contact, true, recipe.dimension);
}

Material PackingStore::in_units(const Recipe& recipe, Contact contact, const Units& units) const {
  contact.young = recipe.young() * units.modulus;
  const std::string name = ensure(recipe);
  TinyPacking packing = read_tiny(directory_ / name);
  for (Disc& disc : packing.discs)
    disc = {disc.x * units.length, disc.y * units.length, disc.radius * units.length};
  packing.cell *= units.length;
  packing.thickness *= units.length;
  return tiny(fmt::format("{}_length{:g}", name, units.length), packing, contact);
}

Material PackingStore::tiny(const std::string& name, const TinyPacking& packing,
                            const Contact& contact) const {
  std::filesystem::create_directories(directory_);
  write_tiny(directory_ / name, packing);
  return from_files(name, contact, false);
}

}  // namespace verification::stability
