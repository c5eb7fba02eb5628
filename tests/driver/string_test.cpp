// Strings of equal discs with bonds, in a cell as high as a disc: Liu's thesis (2018), eq. 4.22, 4.23.

#include "dynamics/specimen.hpp"
#include "material/material.hpp"
#include "state/state.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace grainlaw::core {
namespace {

constexpr double kn = 1e4, density = 2000, thickness = 1e-3;

std::shared_ptr<const Material<2>> string_of(int discs, double radius) {
  MaterialDescription description;
  Packing& packing = description.packing;
  packing.thickness = thickness;
  packing.density = density;
  packing.cell = {2 * radius * discs, 0, 0, 2 * radius};
  packing.radius.assign(static_cast<std::size_t>(discs), radius);
  packing.position.assign(static_cast<std::size_t>(2 * discs), radius);
  packing.names_bonds = true;
  for (int p = 0; p < discs; ++p) {
    packing.position[static_cast<std::size_t>(p)] = (2 * p + 1) * radius;
    const bool closes = p + 1 == discs;  // a contact is named from the lower number
    InitialContact bond;
    bond.i = closes ? 0 : p;
    bond.j = closes ? p : p + 1;
    bond.shift = {closes ? -1 : 0, 0, 0};
    bond.bonded = true;
    packing.contacts.push_back(bond);
  }
  description.law.kind = LawKind::bonded;
  description.law.normal_stiffness = kn;
  description.law.ratio = 0.4;
  description.law.bond.normal_strength = 3e6;
  description.law.bond.tangential_strength = 6e6;
  description.solver.contacts_lost = ContactsLost::stress_free;
  return make_material<2>(std::move(description));
}

TEST(string_of_discs, stress_and_density_depend_on_neither_number_nor_radius) {
  for (const int discs : {2, 8})
    for (const double radius : {1.1e-3, 0.3e-3})
      for (const double a : {0.99, 1.02}) {
        const auto material = string_of(discs, radius);
        EXPECT_NEAR(mean_density(*material) / (std::numbers::pi / 4 * density), 1, 1e-12);
        State<2> state(material);
        const std::array<double, 4> F{a, 0, 0, 1};
        std::array<double, 4> stress{};
        grainlaw_report report{};
        ASSERT_EQ(state.evaluate(F.data(), TangentKind::none, stress.data(), nullptr, report),
                  GRAINLAW_OK)
            << report.message;
        EXPECT_NEAR(stress[0] * thickness / (kn * (a - 1)), 1, 1e-10);
        for (const std::size_t k : {1, 2, 3})
          EXPECT_NEAR(stress[k] * thickness / (kn * (a - 1)), 0, 1e-10);
      }
}

}  // namespace
}  // namespace grainlaw::core
