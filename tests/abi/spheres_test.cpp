// Spheres through the C ABI: 3 x 3 tensors, states, sets and files; and what is plane so far is refused.
#include "support.hpp"

#include <limits>

namespace grainlaw::test {
namespace {

const Material& spheres() {
  static const Material instance = Material::load(data_directory + "/spheres500.toml");
  return instance;
}

using Space = std::array<double, 9>;
constexpr Space sheared{1.0001, 2e-4, 0, 0, 1, 1e-4, -5e-5, 0, 0.9996};

Space space_stress(State& state, const Space& F) {
  Space P{};
  EXPECT_TRUE(state.evaluate(F, P));
  return P;
}

void expect_told(const std::string& text, const std::string& told) {
  const TemporaryDirectory directory;
  write_text(directory / "material.toml", text);
  write_text(directory / "discs.csv", "id,x,y,r\n0,0,0,0.5\n1,1,0,0.5\n");
  write_text(directory / "spheres.csv", "id,x,y,z,r\n0,0,0,0,0.5\n1,1,0,0,0.5\n");
  write_text(directory / "thick.csv",
             "H00,H01,H02,H10,H11,H12,H20,H21,H22,thickness\n2,0,0,0,2,0,0,0,2,0.1\n");
  write_text(directory / "flat.csv", "H00,H01,H02,H10,H11,H12,H20,H21,H22\n2,0,0,0,2,0,0,0,0\n");
  write_text(directory / "cell.csv", "H00,H01,H02,H10,H11,H12,H20,H21,H22\n2,0,0,0,2,0,0,0,2\n");
  write_text(directory / "twice.csv",
             "i,j,shift_x,shift_y,shift_z,fn,ftx_on_j,fty_on_j,ftz_on_j\n0,1,0,0,0,1,0,0,nan\n");
  char message[1024];
  grainlaw_material* made = nullptr;
  const auto path = (directory / "material.toml").string();
  const grainlaw_status found =
      grainlaw_material_load(path.c_str(), &made, message, sizeof message);
  ++bad_inputs;
  EXPECT_LT(found, 0) << told;
  EXPECT_EQ(made, nullptr);
  EXPECT_NE(std::string(message).find(told), std::string::npos) << message << "\nfor " << told;
}

std::string text_of(const std::string& packing, const std::string& rest = "",
                    const std::string& contact =
                        "law = \"frictional\"\nkn = 1e5\nratio = 0.8\n"
                        "friction = 0.5\n") {
  return "dimension = 3\n" + rest + "[packing]\n" + packing + "[contact]\n" + contact;
}

TEST(spheres, have_three_dimensions) {
  EXPECT_EQ(spheres().dimension(), 3);
  State state(spheres());
  EXPECT_EQ(state.measure(GRAINLAW_CAUCHY_STRESS).size(), 9U);
}

TEST(spheres, set_of_points_has_the_bits_of_a_state_with_any_number_of_threads) {
  State state(spheres());
  Space P{};
  std::array<double, 81> A{};
  ASSERT_TRUE(state.evaluate(sheared, P, GRAINLAW_WANT_TANGENT_EXACT, A));
  for (const int threads : {1, 2}) {
    Points points(spheres(), 2);
    std::array<double, 18> F{}, stresses{};
    std::array<double, 162> tangents{};
    for (std::size_t k = 0; k < 18; ++k) F[k] = sheared[k % 9];
    ASSERT_EQ(points.evaluate(F, stresses, GRAINLAW_WANT_TANGENT_EXACT, tangents, threads).status,
              GRAINLAW_OK);
    for (std::size_t k = 0; k < 18; ++k) EXPECT_EQ(stresses[k], P[k % 9]) << threads << ' ' << k;
    for (std::size_t k = 0; k < 162; ++k) EXPECT_EQ(tangents[k], A[k % 81]) << threads << ' ' << k;
  }
}

TEST(spheres, written_packing_goes_on_with_the_same_stress) {
  State state(spheres());
  static_cast<void>(space_stress(state, sheared));
  state.commit();
  const TemporaryDirectory directory;
  state.write_packing((directory / "deformed").string());
  std::string text = read_text(data_directory + "/spheres500.toml");
  for (auto at = text.find("spheres500_"); at != std::string::npos; at = text.find("spheres500_"))
    text.replace(at, 10, "deformed");
  write_text(directory / "deformed.toml", text);
  const Material written = Material::load((directory / "deformed.toml").string());
  State again(written);
  const auto expected = state.measure(GRAINLAW_CAUCHY_STRESS);
  const auto found = again.measure(GRAINLAW_CAUCHY_STRESS);
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(found[k], expected[k], 1e-8 * 1e5) << k;
}

TEST(spheres, refused_increment_leaves_the_state) {
  State state(spheres());
  const Space before = space_stress(state, sheared);
  state.revert();
  const auto bytes = state.save();
  Space P{};
  const Space torn{1, 0, 0, 0, 1, 0, 0, 0, 1e3};
  EXPECT_FALSE(state.evaluate(torn, P));
  const Space nan{1, 0, 0, 0, 1, 0, 0, 0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_THROW(static_cast<void>(state.evaluate(nan, P)), StatusError);
  EXPECT_THROW(static_cast<void>(state.evaluate(std::array<double, 4>{1, 0, 0, 1}, P)),
               StatusError);
  state.revert();
  EXPECT_EQ(state.save(), bytes);
  EXPECT_TRUE(same_bits(space_stress(state, sheared), before));
}

TEST(spheres, bytes_of_discs_are_refused) {
  State discs(material());
  State state(spheres());
  const auto bytes = state.save();
  EXPECT_THROW(state.load(discs.save()), StatusError);
  EXPECT_EQ(state.save(), bytes);
}

TEST(bad_spheres, what_is_plane_is_refused) {
  const std::string files = "particles = \"spheres.csv\"\ncell = \"cell.csv\"\n";
  expect_told(text_of(files, "thickness = 0.1\n"), "thickness");
  expect_told(text_of("generator = \"square\"\ncolumns = 2\nrows = 2\nradius = 0.5\noverlap = 0\n"),
              "found 'square', expected one of \"compaction\"");
  expect_told(text_of(files) + "[boundary]\ntype = \"frame-d\"\n", "periodic-cell");
}

TEST(bad_spheres, mistakes_in_bonds_and_rolling_are_told) {
  const std::string lattice =
      "generator = \"fcc\"\ncells = [2, 2, 2]\nradius = 1e-3\npressure = 1e4\n";
  const auto told = [&](const std::string& keys, const std::string& expected, bool bonded = true) {
    const std::string law = bonded ? "law = \"bonded\"\n" : "law = \"frictional\"\n";
    expect_told(text_of(lattice, "", law + "kn = 1e5\nratio = 0.8\nfriction = 0.5\n" + keys),
                expected);
  };
  const std::string strengths = "bond = { normal_strength = 1, tangential_strength = 1";
  told(strengths + ", torsion_stiffness = 1 }\n", "contact.bond.torsion_strength: found nothing");
  told(strengths + ", torsion_strength = 1 }\n", "torsion_stiffness > 0 with it");
  told("rotation = false\n" + strengths + ", torsion_stiffness = 1, torsion_strength = 1 }\n",
       "contact.rotation = true with it");
  told("rolling = { ratio = 1, friction = 0.1, twisting_ratio = 1 }\n",
       "contact.rolling.twisting_friction: found nothing", false);
  told("rolling = { ratio = 1, friction = 0.1, twisting_ratio = 0, twisting_friction = 1 }\n",
       "contact.rolling.twisting_ratio: found 0", false);
}

TEST(spheres, bonds_and_moments_go_through_files) {
  const std::string contact =
      "law = \"bonded\"\nkn = 1e5\nratio = 0.8\nfriction = 0.5\n"
      "rolling = { ratio = 1, friction = 0.1, twisting_ratio = 1, twisting_friction = 0.1 }\n"
      "bond = { normal_strength = 1e9, tangential_strength = 1e9, bending_stiffness = 1e-2, "
      "bending_strength = 1e9, torsion_stiffness = 1e-2, torsion_strength = 1e9 }\n";
  const Material made = Material::parse(
      text_of("generator = \"compaction\"\ncount = 40\nradii = [1e-3, 2e-3]\nseed = 1\n"
              "pressure = 1e5\n",
              "", contact),
      ".");
  State state(made);
  static_cast<void>(space_stress(state, sheared));
  state.commit();
  const TemporaryDirectory directory;
  state.write_packing((directory / "bonded").string());
  const std::string contacts = read_text((directory / "bonded_contacts.csv").string());
  EXPECT_NE(contacts.find("moment_x,moment_y,moment_z,bonded,bond_gap"), std::string::npos);
  const Material again = Material::parse(
      text_of("particles = \"bonded_particles.csv\"\ncontacts = \"bonded_contacts.csv\"\n"
              "cell = \"bonded_cell.csv\"\n",
              "", contact),
      (directory / "").string());
  State read(again);
  const auto expected = state.measure(GRAINLAW_CAUCHY_STRESS);
  const auto found = read.measure(GRAINLAW_CAUCHY_STRESS);
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(found[k], expected[k], 1e-8 * 1e5) << k;
  EXPECT_NEAR(read.measure(GRAINLAW_ELASTIC_ENERGY)[0], state.measure(GRAINLAW_ELASTIC_ENERGY)[0],
              1e-8 * state.measure(GRAINLAW_ELASTIC_ENERGY)[0]);
  // Saved bytes too.
  State copy(made);
  copy.load(state.save());
  const Space next{1.0002, 2e-4, 0, 0, 1, 1e-4, -5e-5, 0, 0.9995};
  EXPECT_TRUE(same_bits(space_stress(copy, next), space_stress(state, next)));
}

TEST(bad_spheres, mistakes_in_generators_are_told) {
  const auto told = [](const std::string& keys, const std::string& expected) {
    expect_told(text_of("generator = \"bcc\"\nradius = 1e-3\n" + keys), expected);
  };
  told("pressure = 1e4\n", "packing.cells: found nothing, expected three integers from 1 to 100");
  told("pressure = 1e4\ncells = [2, 2]\n", "packing.cells: found [ 2, 2 ]");
  told("pressure = 1e4\ncells = [2, 0, 2]\n", "packing.cells: found [ 2, 0, 2 ]");
  told("cells = [2, 2, 2]\n", "either pressure or overlap");
  told("cells = [2, 2, 2]\npressure = 1e4\ncolumns = 2\n", "packing.columns: found an unknown key");
  told("cells = [2, 2, 2]\npressure = 1e9\n", "at most 1e+07 Pa, a fifth of kn / diameter");
  told("cells = [2, 2, 2]\noverlap = 3e-4\n", "a length >= 0 and below 0.000267");
}

TEST(bad_spheres, mistakes_in_random_packings_are_told) {
  const auto told = [](const std::string& keys, const std::string& expected) {
    expect_told(text_of("generator = \"lubachevsky-stillinger\"\ncount = 10\nseed = 1\n"
                        "radii = [1e-3, 2e-3]\n" +
                        keys),
                expected);
  };
  told("pressure = 1e4\nvolume_fraction = 0.8\n", "a number from 0.25 to 0.74");
  told("pressure = 1e4\nvolume_fraction = 0.72\n", "the spheres jam at a volume fraction of 0.");
  told("pressure = 1e9\n", "a fifth of kn / diameter");
  told("pressure = 1e4\nfriction = 0.4\nanisotropy = 0.1\nanisotropy_direction = [0, 0, 0]\n",
       "three numbers, not all 0");
  told("pressure = 1e4\nfriction = 0.4\nanisotropy = 0.1\nanisotropy_direction = 45\n",
       "three numbers, not all 0");
  told("pressure = 1e4\nanisotropy = 0.1\n", "needs shear strength");
}

TEST(spheres, packing_from_a_material_file_has_its_pressure) {
  for (const std::string generator : {"compaction", "lubachevsky-stillinger"}) {
    const Material made = Material::parse(
        text_of("generator = \"" + generator +
                "\"\ncount = 40\nradii = [1e-3, 2e-3]\nseed = 1\npressure = 1e5\nfriction = 0.2\n"),
        ".");
    State state(made);
    const auto sigma = state.measure(GRAINLAW_CAUCHY_STRESS);
    for (const std::size_t k : {0U, 4U, 8U}) EXPECT_NEAR(sigma[k], -1e5, 0.1) << generator;
    EXPECT_EQ(state.measure(GRAINLAW_PARTICLES)[0], 40);
    const TemporaryDirectory directory;
    state.write_packing((directory / "made").string());
  }
}

TEST(spheres, lattice_from_a_material_file_is_led_and_written) {
  const Material made = Material::parse(
      text_of("generator = \"hcp\"\ncells = [3, 2, 2]\nradius = 1e-3\npressure = 1e6\n"), ".");
  State state(made);
  Space P{};
  std::array<double, 81> A{};
  const auto result = state.evaluate(sheared, P, GRAINLAW_WANT_TANGENT_EXACT, A);
  ASSERT_TRUE(result) << result.report.message;
  EXPECT_EQ(state.measure(GRAINLAW_COORDINATION)[0], 12);
  state.commit();
  const TemporaryDirectory directory;
  state.write_packing((directory / "lattice").string());
  state.write_vtk((directory / "lattice.vtp").string());
  EXPECT_NE(read_text((directory / "lattice.vtp").string()).find("radius"), std::string::npos);
}

TEST(bad_spheres, mistakes_in_files_are_told) {
  const std::string cell = "cell = \"cell.csv\"\n", particles = "particles = \"spheres.csv\"\n";
  expect_told(text_of("particles = \"discs.csv\"\n" + cell), "'z'");
  expect_told(text_of(particles + "cell = \"thick.csv\"\n"), "'thickness'");
  expect_told(text_of(particles + "cell = \"flat.csv\"\n"), "det H > 0");
  expect_told(text_of(particles + cell + "contacts = \"twice.csv\"\n"), "ftz_on_j");
  expect_told("dimension = 4\n[packing]\n" + particles + cell +
                  "[contact]\nlaw = \"compressive\"\nkn = 1\n",
              "2 (discs) or 3 (spheres)");
}

}  // namespace
}  // namespace grainlaw::test
