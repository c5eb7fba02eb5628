// `grainlaw_evidence asymmetry`: how far Cauchy stress is from symmetric where drag takes moments.

#include "evidence/studies/study.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>

namespace verification {
namespace {

struct Packing {
  const char* name;
  int dimension;
  MaterialSource source;
};

MaterialSource with_drag(MaterialSource source) {
  change(source, "solver", "viscous_number", 1e-3);
  return source;
}

MaterialSource of_file(const StudyOptions& options, const char* name) {
  MaterialSource source;
  source.file = options.scene(std::string("../../tests/data/") + name);
  source.base = source.file.parent_path();
  return with_drag(source);
}

MaterialSource generated(int dimension, double young) {
  MaterialSource source;
  source.changes.insert("dimension", dimension);
  if (dimension == 2) source.changes.insert("thickness", 0.1);
  for (const auto& [key, value] : {std::pair{"seed", 1}, {"count", 60}})
    change(source, "packing", key, value);
  change(source, "packing", "generator", "compaction");
  change(source, "packing", "radii", toml::array{4e-3, 8e-3});
  change(source, "packing", "pressure", 1e5);
  change(source, "contact", "law", "frictional");
  change(source, "contact", "young", young);
  change(source, "contact", "ratio", 0.8);
  change(source, "contact", "friction", 0.5);
  return with_drag(source);
}

struct Largest {
  double asymmetry = 0, unbalanced = 0, ratio = 0;
  double steps = 0;
};

// Compressed and sheared by 2 %, half of it taken back, in increments of so much.
template <int D>
Largest lead(const Material& material, double increment) {
  constexpr double there = 0.02, back = 0.01;
  TensorOf<D> direction = 0.4 * TensorOf<D>::Identity();
  direction(D - 1, D - 1) = -1;
  direction(0, D - 1) = 0.5;
  direction(1, 0) = 0.3;
  State state(material);
  TensorOf<D> F = TensorOf<D>::Identity();
  Largest largest;
  const auto go = [&](double strain, double sign) {
    for (int n = static_cast<int>(std::lround(strain / increment)); n > 0; --n) {
      F += sign * increment * direction;
      const EvaluationOf<D> at = evaluate_of<D>(state, F, 0);
      check(at.status, "an increment with drag");
      state.commit();
      const TensorOf<D> sigma = cauchy_stress_of<D>(at.stress, F);
      const double asymmetry = (sigma - sigma.transpose()).cwiseAbs().maxCoeff() / sigma.norm();
      largest.asymmetry = std::max(largest.asymmetry, asymmetry);
      largest.unbalanced = std::max(largest.unbalanced, at.report.unbalanced);
      largest.ratio = std::max(largest.ratio, asymmetry / at.report.unbalanced);
      ++largest.steps;
    }
  };
  go(there, 1);
  go(back, -1);
  return largest;
}

void study_asymmetry(const StudyOptions& options) {
  const std::vector<Packing> packings{
      {"400 discs of YADE's", 2, of_file(options, "rve400.toml")},
      {"60 discs", 2, generated(2, 6e8)},
      {"60 discs, a hundred times as stiff", 2, generated(2, 6e10)},
      {"500 spheres of YADE's", 3, of_file(options, "spheres500.toml")},
      {"60 spheres", 3, generated(3, 1e8)},
  };
  Table table(
      "viscous_number = 1e-3, compressed and sheared by 2 %, half of it taken back: the largest "
      "|sigma_ij - sigma_ji| / |sigma|, unbalanced force, and ratio of the two",
      {"packing", "increment[-]", "steps", "asymmetry[-]", "unbalanced[-]",
       "asymmetry/unbalanced[-]"});
  for (const Packing& packing : packings) {
    const Material material = make_material(packing.source, packing.dimension);
    for (const double increment : {5e-3, 1e-3, 2.5e-4}) {
      const Largest found =
          packing.dimension == 2 ? lead<2>(material, increment) : lead<3>(material, increment);
      table.row(
          {packing.name, increment, found.steps, found.asymmetry, found.unbalanced, found.ratio});
    }
  }
  table.print();
  table.write(std::filesystem::path(options.output) / "study_asymmetry.csv");
}

}  // namespace

void add_asymmetry_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  study.add_subcommand("asymmetry", "of Cauchy stress with drag")->callback([options] {
    study_asymmetry(*options);
  });
}

}  // namespace verification
