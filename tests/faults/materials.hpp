// A small packing under every contact law, boundary condition and method.
#pragma once

#include "api/handle.hpp"
#include "boundary_support.hpp"
#include "law_support.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace grainlaw::core::test {

struct NamedMaterial {
  std::string name;
  std::shared_ptr<const Material> material;
};

inline std::vector<NamedMaterial> every_material() {
  const Packing& packing = small_packing();
  Spaces all = all_spaces(packing);
  all.emplace_back("compressive", describe_law(packing, compressive_law()));
  all.emplace_back("smooth", describe(packing, smooth_law()));
  all.emplace_back("locked", describe(packing, locked_law()));
  for (const auto& [name, law] : composite_laws())
    all.emplace_back(name, describe_law(packing, law));
  auto slow = describe(packing, rough_law(), BoundaryType::frame_p, 1e-4);
  slow.solver.method = Method::advancing;
  all.emplace_back("advancing", slow);
  slow.solver.method = Method::published;
  all.emplace_back("published", slow);
  slow.boundary.method = BoundaryMethod::servo;
  all.emplace_back("servo", slow);
  std::vector<NamedMaterial> result;
  for (const auto& [name, description] : all) result.push_back({name, make_material(description)});
  return result;
}

struct DestroyHandle {
  void operator()(grainlaw_state* state) const { grainlaw_state_destroy(state); }
};
using StateHandle = std::unique_ptr<grainlaw_state, DestroyHandle>;

}  // namespace grainlaw::core::test
