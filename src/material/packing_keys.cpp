#include "material/packing_keys.hpp"

#include <numbers>

namespace grainlaw::core {

namespace {

void read_rows(TomlTable& table, GeneratorOptions& generator) {
  constexpr long most = 10000;
  table.required("columns", integer_between(2, most), generator.columns);
  table.required("rows", integer_between(2, most), generator.rows);
  if (generator.kind == GeneratorKind::hexagonal && generator.rows % 2 != 0)
    table.fail("rows", std::to_string(generator.rows), "an even number of rows");
}

void read_cells(TomlTable& table, GeneratorOptions& generator) {
  constexpr long most = 100;
  const auto cells = table.required("cells", three_integers_between(1, most));
  for (std::size_t k = 0; k < 3; ++k) generator.cells[k] = static_cast<std::size_t>(cells[k]);
}

void read_regular(TomlTable& table, GeneratorOptions& generator, long dimension) {
  dimension == 3 ? read_cells(table, generator) : read_rows(table, generator);
  table.required("radius", number_above(0), generator.radius_max);
  table.require_either("pressure", "overlap");
  table.optional("pressure", number_above(0), generator.pressure);
  generator.overlap = table.optional("overlap", number_between(0, 0.5 * generator.radius_max));
  table.optional("radius_spread", number_between(0, 0.1), generator.radius_spread);
  if (generator.radius_spread > 0) table.required("seed", integer_between(0), generator.seed);
}

void read_anisotropy(TomlTable& table, GeneratorOptions& generator, long dimension) {
  table.optional("anisotropy", number_between(0, 0.5), generator.anisotropy);
  if (dimension == 3) {
    table.optional("anisotropy_direction", direction(), generator.anisotropy_axis);
  } else {
    double degrees = 0;
    table.optional("anisotropy_direction", number_between(-180, 180), degrees);
    generator.anisotropy_direction = degrees * std::numbers::pi / 180;
  }
  if (table.has("anisotropy_direction") && !table.has("anisotropy"))
    table.fail("anisotropy", "nothing", "a number with anisotropy_direction");
  if (table.has("anisotropy") && !(generator.friction > 0))
    table.fail("friction", "none", "a number > 0, since anisotropy needs shear strength");
}

void read_random(TomlTable& table, GeneratorOptions& generator, long dimension) {
  table.required("count", integer_between(2, 1000000), generator.count);
  const auto radii = table.required("radii", positive_range());
  generator.radius_min = radii[0];
  generator.radius_max = radii[1];
  table.required("seed", integer_between(0), generator.seed);
  generator.finds_friction = table.has("pressure") && table.has("void_ratio");
  if (!generator.finds_friction) table.require_either("pressure", "void_ratio");
  for (const char* key : {"friction", "anisotropy"})
    if (generator.finds_friction && table.has(key))
      table.fail(key, "a number",
                 "none beside pressure and void_ratio together, which find friction");
  table.optional("pressure", number_above(0), generator.pressure);
  table.optional("void_ratio", number_above(0), generator.void_ratio);
  table.optional("friction", number_at_least(0), generator.friction);
  read_anisotropy(table, generator, dimension);
  if (generator.kind != GeneratorKind::lubachevsky_stillinger) return;
  table.optional("growth_rate", number_between(1e-5, 1), generator.growth_rate);
  const auto fraction = dimension == 3 ? number_between(0.25, 0.74) : number_between(0.4, 0.95);
  table.optional("volume_fraction", fraction, generator.growth_end);
}

}  // namespace

GeneratorOptions read_generator(TomlTable& table, long dimension) {
  GeneratorOptions generator;
  const auto compaction = std::pair("compaction", GeneratorKind::compaction);
  const auto growth = std::pair("lubachevsky-stillinger", GeneratorKind::lubachevsky_stillinger);
  const auto kinds = dimension == 3
                         ? one_of<GeneratorKind>({compaction,
                                                  growth,
                                                  {"sc", GeneratorKind::sc},
                                                  {"bcc", GeneratorKind::bcc},
                                                  {"fcc", GeneratorKind::fcc},
                                                  {"hcp", GeneratorKind::hcp}})
                         : one_of<GeneratorKind>({compaction,
                                                  growth,
                                                  {"square", GeneratorKind::square},
                                                  {"hexagonal", GeneratorKind::hexagonal}});
  generator.kind = table.required("generator", kinds);
  if (generator.regular()) {
    read_regular(table, generator, dimension);
  } else {
    read_random(table, generator, dimension);
  }
  return generator;
}

}  // namespace grainlaw::core
