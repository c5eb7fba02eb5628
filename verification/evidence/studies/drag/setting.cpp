#include "evidence/studies/drag/setting.hpp"

#include <fmt/format.h>

#include <utility>

namespace verification::drag {
namespace {

constexpr double thickness = 0.1;  // of discs [m]

// Radii of the recipe [m].
double smallest_radius() { return 3e-3; }
double largest_radius(int dimension) { return dimension == 2 ? 7e-3 : 6e-3; }
double mean_radius(int dimension) { return 0.5 * (smallest_radius() + largest_radius(dimension)); }

std::string contact_text(const Packing& packing) {
  return fmt::format("[contact]\nlaw = \"frictional\"\nyoung = {}\nratio = 0.8\nfriction = {}\n",
                     packing.young * nudged(packing.repeat), packing.friction);
}

Material parse(const std::string& text) { return Material::parse(text, "."); }

}  // namespace

std::string Packing::name() const {
  if (!file.empty()) return file;
  return fmt::format("{} {} {}", count, dimension == 2 ? "discs" : "spheres", seed);
}

std::vector<Packing> discs(int packings, int count) {
  std::vector<Packing> list;
  for (long seed = 1; seed <= packings; ++seed) list.push_back({.count = count, .seed = seed});
  return list;
}

std::vector<Packing> spheres(int packings, int count) {
  std::vector<Packing> list;
  for (long seed = 1; seed <= packings; ++seed)
    list.push_back({.dimension = 3, .count = count, .seed = seed, .young = 1e8});
  return list;
}

double stiffness_ratio(const Packing& packing) {
  const double extent = packing.dimension == 2 ? mean_radius(2) / thickness : 1;
  return packing.young * extent / pressure;
}

double young_of(int dimension, double stiffness_ratio) {
  const double extent = dimension == 2 ? mean_radius(2) / thickness : 1;
  return stiffness_ratio * pressure / extent;
}

Materials::Materials(const StudyOptions& options, double number, std::vector<std::string> keys)
    : options_(options), number_(number), keys_(std::move(keys)) {}

Material Materials::operator()(const Packing& packing, const Setting& setting) {
  return read(prefix_of(packing), packing, setting);
}

Material Materials::at_rest(const State& state, const Packing& packing) {
  const std::string prefix = (scratch_ / "at_rest").string();
  state.write_packing(prefix);
  return read(prefix, packing, equilibrium);
}

// Consolidation is without friction, so that the packing does not depend on that of its contacts.
std::string Materials::prefix_of(const Packing& packing) {
  if (!packing.file.empty())
    return options_.scene("../../tests/data/" + packing.file + ".toml").replace_extension("");
  const std::string name =
      fmt::format("{}_{}_{}_{}", packing.dimension, packing.count, packing.seed, packing.young);
  const auto [entry, is_new] = made_.try_emplace(name, (scratch_ / name.c_str()).string());
  if (is_new) {
    const Material material = parse(fmt::format(
        "dimension = {}\n{}[packing]\ngenerator = \"compaction\"\ncount = {}\nradii = [{}, {}]\n"
        "seed = {}\npressure = {}\nfriction = 0.0\n{}",
        packing.dimension, packing.dimension == 2 ? fmt::format("thickness = {}\n", thickness) : "",
        packing.count, smallest_radius(), largest_radius(packing.dimension), packing.seed, pressure,
        contact_text(packing)));
    State(material).write_packing(entry->second);
  }
  return entry->second;
}

Material Materials::read(const std::string& prefix, const Packing& packing,
                         const Setting& setting) const {
  std::string text = fmt::format(
      "dimension = {}\n[packing]\nparticles = \"{}_particles.csv\"\ncontacts = "
      "\"{}_contacts.csv\"\ncell = \"{}_cell.csv\"\n{}[solver]\ntolerance = {}\n",
      packing.dimension, prefix, prefix, prefix, contact_text(packing), setting.tolerance);
  if (setting.from_trial) text += "start = \"trial\"\n";
  if (setting.stress_free) text += "contacts_lost = \"stress_free\"\n";
  if (!setting.in_time) return parse(text);
  if (number_ > 0) text += fmt::format("viscous_number = {}\n", setting.share * number_);
  if (setting.rate > 0) text += fmt::format("viscous_rate = {}\n", setting.rate);
  if (setting.parts > 1) text += fmt::format("viscous_steps = {}\n", setting.parts);
  for (const std::string& key : keys_) text += key + "\n";
  return parse(text);
}

}  // namespace verification::drag
