// Contact laws that cannot be: the message names file, line, key and expectation.
#include "support.hpp"

#include <cstring>

namespace grainlaw::test {
namespace {

const std::string head =
    "dimension = 2\n"
    "[packing]\n"
    "particles = \"rve400_particles.csv\"\n"
    "cell = \"rve400_cell.csv\"\n"
    "[contact]\n";  // line 5

struct Mistake {
  const char* contact;  // from line 6 on
  int line;
  const char* key;
  const char* expected;
};

const std::string frictional = "young = 6e8\nratio = 0.8\nfriction = 0.5\n";
const std::string strengths = "normal_strength = 10\ntangential_strength = 5\n";

void expect_told(const Mistake& mistake) {
  const std::string text = head + mistake.contact;
  char message[512];
  grainlaw_material* made = nullptr;
  expect_refused(
      grainlaw_material_parse(text.c_str(), data_directory.c_str(), &made, message, sizeof message),
      GRAINLAW_BAD_MATERIAL, mistake.contact);
  EXPECT_EQ(made, nullptr);
  const std::string place =
      data_directory + ":" + std::to_string(mistake.line) + ": " + mistake.key + ": ";
  EXPECT_EQ(std::string(message).rfind(place, 0), 0U) << message << "\nexpected at " << place;
  EXPECT_NE(std::strstr(message, mistake.expected), nullptr) << message;
}

TEST(bad_contact_law, keys_of_another_law_are_told) {
  const Mistake mistakes[] = {
      {"law = \"cohesive\"", 6, "contact.law",
       "expected one of \"frictional\", \"compressive\", \"bonded\", \"hertz\""},
      {"law = \"compressive\"", 5, "contact.young", "either young or kn"},
      {"law = \"compressive\"\nkn = -1", 7, "contact.kn", "found -1, expected a number > 0"},
      {"law = \"compressive\"\nkn = 1e4\nfriction = 0.5", 8, "contact.friction",
       "found an unknown key, expected one of law, young, kn"},
      {"law = \"compressive\"\nkn = 1e4\nratio = 0.5", 8, "contact.ratio", "an unknown key"},
      {"law = \"compressive\"\nkn = 1e4\n[contact.rolling]", 8, "contact.rolling",
       "an unknown key"},
      {"law = \"hertz\"\nyoung = 6e8", 5, "contact.shear_modulus", "found nothing"},
      {"law = \"hertz\"\nshear_modulus = 0", 7, "contact.shear_modulus", "a number > 0"},
      {"law = \"hertz\"\nshear_modulus = -1e9", 7, "contact.shear_modulus", "a number > 0"},
      {"law = \"hertz\"\nshear_modulus = 1e9", 5, "contact.poisson",
       "found nothing, expected a number from 0 to 0.5"},
      {"law = \"hertz\"\nshear_modulus = 1e9\npoisson = 0.6", 8, "contact.poisson",
       "a number from 0 to 0.5"},
      {"law = \"hertz\"\nshear_modulus = 1e9\npoisson = 0.2", 5, "contact.friction",
       "found nothing"},
      {"law = \"hertz\"\nshear_modulus = 1e9\npoisson = 0.2\nfriction = 0.5\nyoung = 6e8", 10,
       "contact.young", "an unknown key"},
      {"law = \"hertz\"\nshear_modulus = 1e9\npoisson = 0.2\nfriction = 0.5\nratio = 0.8", 10,
       "contact.ratio", "an unknown key"},
      {"law = \"hertz\"\nshear_modulus = 1e9\npoisson = 0.2\nfriction = 0.5\n[contact.bond]", 10,
       "contact.bond", "an unknown key"},
  };
  for (const Mistake& mistake : mistakes) expect_told(mistake);
}

TEST(bad_contact_law, rolling_that_cannot_act_is_told) {
  const std::string law = "law = \"frictional\"\n";
  const struct {
    std::string contact;
    int line;
    const char* key;
    const char* expected;
  } mistakes[] = {
      {law + frictional + "[contact.rolling]", 10, "contact.rolling.ratio", "found nothing"},
      {law + frictional + "[contact.rolling]\nratio = 1", 10, "contact.rolling.friction",
       "found nothing"},
      {law + frictional + "[contact.rolling]\nratio = 0\nfriction = 0.1", 11,
       "contact.rolling.ratio", "a number > 0"},
      {law + frictional + "[contact.rolling]\nratio = 1\nfriction = -0.1", 12,
       "contact.rolling.friction", "a number > 0"},
      {law + frictional + "[contact.rolling]\nratio = 1\nfriction = 0.1\nlength = 1", 13,
       "contact.rolling.length", "an unknown key"},
      {law + frictional + "rolling = 0.1", 10, "contact.rolling", "a table"},
      {law + frictional + "rotation = false\n[contact.rolling]\nratio = 1\nfriction = 0.1", 10,
       "contact.rotation", "true with [contact.rolling]"},
      {law + "kn = 1e4\nratio = 0.8\nfriction = 0\n[contact.rolling]\nratio = 1\nfriction = 0.1", 9,
       "contact.friction", "a number > 0 with [contact.rolling]"},
      {law + "kn = 1e4\nratio = 0\nfriction = 1\n[contact.rolling]\nratio = 1\nfriction = 0.1", 8,
       "contact.ratio", "a number > 0 with [contact.rolling]"},
  };
  for (const auto& [contact, line, key, expected] : mistakes)
    expect_told({contact.c_str(), line, key, expected});
}

TEST(bad_contact_law, a_bond_without_strength_is_told) {
  const std::string law = "law = \"bonded\"\n" + frictional;
  const struct {
    std::string contact;
    int line;
    const char* key;
    const char* expected;
  } mistakes[] = {
      {law, 5, "contact.bond", "found nothing, expected a table"},
      {"law = \"frictional\"\n" + frictional + "[contact.bond]\n" + strengths, 10, "contact.bond",
       "an unknown key"},
      {law + "[contact.bond]", 10, "contact.bond.normal_strength", "found nothing"},
      {law + "[contact.bond]\nnormal_strength = 10", 10, "contact.bond.tangential_strength",
       "found nothing"},
      {law + "[contact.bond]\nnormal_strength = 0\ntangential_strength = 5", 11,
       "contact.bond.normal_strength", "a number > 0"},
      {law + "[contact.bond]\nnormal_strength = 10\ntangential_strength = -5", 12,
       "contact.bond.tangential_strength", "a number > 0"},
      {law + "[contact.bond]\nnormal_strength = inf\ntangential_strength = 5", 11,
       "contact.bond.normal_strength", "found inf"},
      {law + "[contact.bond]\n" + strengths + "normal_stiffness = 1e4", 10,
       "contact.bond.tangential_stiffness",
       "found nothing, expected both of normal_stiffness and tangential_stiffness, or neither"},
      {law + "[contact.bond]\n" + strengths + "tangential_stiffness = 0", 13,
       "contact.bond.tangential_stiffness", "found 0, expected a number > 0"},
      {law + "[contact.bond]\n" + strengths + "bending_stiffness = -1", 13,
       "contact.bond.bending_stiffness", "found -1, expected a number >= 0"},
      {law + "[contact.bond]\n" + strengths + "bending_stiffness = 1", 10,
       "contact.bond.bending_strength", "a number > 0 with bending_stiffness > 0"},
      {law + "[contact.bond]\n" + strengths + "bending_strength = 1", 13,
       "contact.bond.bending_strength", "bending_stiffness > 0 with it"},
      {law + "[contact.bond]\n" + strengths + "gap = -1e-6", 13, "contact.bond.gap",
       "a number >= 0"},
      {law + "[contact.bond]\n" + strengths + "stiffness = 1", 13, "contact.bond.stiffness",
       "an unknown key"},
      {law + "rotation = false\n[contact.bond]\n" + strengths +
           "bending_stiffness = 1\nbending_strength = 1",
       14, "contact.bond.bending_stiffness", "contact.rotation = true with it"},
      {"law = \"bonded\"\nkn = 1e4\nratio = 0\nfriction = 0.5\n[contact.bond]\n" + strengths, 8,
       "contact.ratio", "a number > 0 with law = \"bonded\""},
  };
  for (const auto& [contact, line, key, expected] : mistakes)
    expect_told({contact.c_str(), line, key, expected});
}

}  // namespace
}  // namespace grainlaw::test
