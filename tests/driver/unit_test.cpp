// Units of columns, in SI.
#include "import/unit.hpp"

#include <gtest/gtest.h>

namespace verification {
namespace {

double value(const char* unit, Quantity quantity) { return in_si(unit, quantity).value_or(0); }

TEST(unit, names_of_quantities_are_converted) {
  EXPECT_DOUBLE_EQ(value("mm", Quantity::length), 1e-3);
  EXPECT_DOUBLE_EQ(value("\u00b5m", Quantity::length), 1e-6);
  EXPECT_DOUBLE_EQ(value("kN", Quantity::force), 1e3);
  EXPECT_DOUBLE_EQ(value("mN", Quantity::force), 1e-3);
  EXPECT_DOUBLE_EQ(value("g/cm3", Quantity::density), 1e3);
  EXPECT_DOUBLE_EQ(value("kg m^-3", Quantity::density), 1);
  for (const char* newton_metre : {"N m", "Nm", "N*m", "N.m", "kg m2/s2"})
    EXPECT_DOUBLE_EQ(value(newton_metre, Quantity::moment), 1) << newton_metre;
  EXPECT_DOUBLE_EQ(value("N/mm", Quantity::stiffness), 1e3);
}

TEST(unit, unknown_ones_and_those_of_another_quantity_are_none) {
  for (const char* unit : {"", "inch", "mmm", "N", "m2", "m^", "1", "m-"})
    EXPECT_FALSE(in_si(unit, Quantity::length)) << unit;
}

TEST(unit, units_of_lammps_agree_with_each_other) {
  EXPECT_DOUBLE_EQ(units_of_lammps("cgs")->of(Quantity::moment).value(), 1e-7);
  EXPECT_DOUBLE_EQ(units_of_lammps("nano")->of(Quantity::stiffness).value(), 1e-3);
  EXPECT_FALSE(units_of_lammps("lj")->of(Quantity::length));
  EXPECT_FALSE(units_of_lammps("metal"));
}

}  // namespace
}  // namespace verification
