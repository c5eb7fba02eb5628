// What MGIS reads from a library before it calls anything (LibrariesManager.cxx): names and types
// of symbols, and values that it refuses otherwise.
#include "mgis_host.hpp"

#include <gtest/gtest.h>

namespace grainlaw::test {
namespace {

class mgis_description : public testing::Test {
 protected:
  BehaviourLibrary library{std::string(GRAINLAW_BEHAVIOURS) + "/libRve400.so"};

  unsigned short number(const std::string& name) const {
    return *library.symbol<unsigned short>("Rve400_" + name);
  }
  std::vector<std::string> names(const std::string& name) const {
    const auto* values = library.symbol<const char*>("Rve400_" + name);
    return {values, values + number("n" + name)};
  }
  std::vector<int> types(const std::string& name) const {
    const auto* values = library.symbol<int>("Rve400_" + name + "Types");
    return {values, values + number("n" + name)};
  }
};

TEST_F(mgis_description, is_a_finite_strain_behaviour_of_api_version_1) {
  EXPECT_EQ(number("mfront_mkt"), 1);
  EXPECT_EQ(number("api_version"), 1);
  EXPECT_EQ(number("BehaviourType"), 2);
  EXPECT_EQ(number("BehaviourKinematic"), 3);
  EXPECT_EQ(number("SymmetryType"), 0);
}

TEST_F(mgis_description, names_what_goes_in_and_out) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(names("ModellingHypotheses"), (Names{"PlaneStrain", "Tridimensional"}));
  EXPECT_EQ(names("Gradients"), Names{"DeformationGradient"});
  EXPECT_EQ(types("Gradients"), std::vector<int>{3});
  EXPECT_EQ(names("ThermodynamicForces"), Names{"Stress"});
  EXPECT_EQ(types("ThermodynamicForces"), std::vector<int>{1});
  EXPECT_EQ(names("TangentOperatorBlocks"), (Names{"Stress", "DeformationGradient"}));
  EXPECT_EQ(names("InternalStateVariables"), (Names{"GrainlawPoint", "GrainlawStep"}));
  EXPECT_EQ(types("InternalStateVariables"), (std::vector<int>{0, 0}));
}

TEST_F(mgis_description, asks_for_nothing_else) {
  for (const char* name : {"MaterialProperties", "ExternalStateVariables", "Parameters",
                           "InitializeFunctions", "PostProcessings"}) {
    EXPECT_TRUE(names(name).empty()) << name;
  }
  EXPECT_TRUE(types("ExternalStateVariables").empty());
  EXPECT_TRUE(types("Parameters").empty());
  for (const char* name : {"requiresStiffnessTensor", "requiresThermalExpansionCoefficientTensor",
                           "ComputesInternalEnergy", "ComputesDissipatedEnergy"}) {
    EXPECT_EQ(number(name), 0) << name;
  }
}

TEST_F(mgis_description, has_a_function_for_each_hypothesis) {
  EXPECT_NO_THROW(library.symbol<int(mfront_gb_BehaviourData*)>("Rve400_PlaneStrain"));
  EXPECT_NO_THROW(library.symbol<int(mfront_gb_BehaviourData*)>("Rve400_Tridimensional"));
}

}  // namespace
}  // namespace grainlaw::test
