// Direct simulation: a repeated frame is the frame, one frame is a point, bad scenes are refused.
#include "../temporary_directory.hpp"
#include "app/csv.hpp"
#include "app/packing_source.hpp"
#include "dns/repeat.hpp"
#include "dns/run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

namespace verification {
namespace {

const std::string material = R"(
[material]
dimension = 2
thickness = 1e-3
solver.tolerance = 1e-9
packing = { generator = "lubachevsky-stillinger", count = 60, radii = [0.3e-3, 0.45e-3], seed = 3, pressure = 100e3 }
contact = { law = "frictional", kn = 1e4, ratio = 0.2, friction = 0.4 }
)";

const std::string biaxial = R"(
[start]
sigma11 = -120e3
sigma12 = 0
sigma22 = -120e3
[[segment]]
steps = 4
stretch22 = 0.996
P11 = "held"
P12 = "held"
)";

class dns : public testing::Test {
 protected:
  [[nodiscard]] std::vector<SpecimenScene> scenes(const std::string& text) const {
    const auto path = directory_ / "scene.toml";
    std::ofstream(path) << text;
    return read_specimen_scenes(SceneFile(path));
  }
  [[nodiscard]] SpecimenScene scene(const std::string& keys) const {
    return scenes(keys + material).front();
  }
  [[nodiscard]] MaterialSource frame_source() const {
    MaterialSource source = scene("repeat = [1, 1]\n" + biaxial).material;
    source.changes.insert_or_assign("boundary", toml::table{{"type", "frame-p"}});
    return source;
  }
  [[nodiscard]] std::string write_packing(const Material& of, const std::string& name) const {
    const std::string prefix = directory_ / name;
    State(of).write_packing(prefix);
    return prefix;
  }
  void expect_refusal(const std::string& text, const std::vector<std::string>& parts) {
    try {
      for (const SpecimenScene& one : scenes(text)) Specimen(one, directory_ / "refused");
      ADD_FAILURE() << "nothing was refused in\n" << text;
    } catch (const InputError& error) {
      for (const std::string& part : parts)
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
            << error.what() << "\nlacks: " << part;
    }
  }

  grainlaw::test::TemporaryDirectory directory_;
};

double difference(const Tensor& a, const Tensor& b) { return (a - b).norm() / b.norm(); }

TEST_F(dns, a_repeated_frame_has_the_copies_and_shares_the_sides) {
  const FramePacking one = read_frame(write_packing(make_material(frame_source()), "one"));
  const FramePacking same = repeat(one, 1, 1);
  EXPECT_EQ(same.size(), one.size());
  EXPECT_EQ(same.contacts.size(), one.contacts.size());
  EXPECT_EQ(same.boundary.size(), one.boundary.size());
  const std::size_t across = one.corner[1], up = one.corner[2] - one.corner[1];
  const FramePacking many = repeat(one, 3, 2);
  const std::size_t cell = one.size() - across - up - 1;  // of the periodic packing
  EXPECT_EQ(many.size(), 6 * cell + 3 * across + 2 * up + 1);
  EXPECT_EQ(many.boundary.size(), 2 * (3 * across + 2 * up));
  EXPECT_EQ(many.corner,
            (std::array<std::size_t, 4>{0, 3 * across, 3 * across + 2 * up, 6 * across + 2 * up}));
}

TEST_F(dns, a_repeated_frame_carries_the_stress_of_the_frame) {
  const MaterialSource source = frame_source();
  const Material frame = make_material(source);
  const FramePacking one = read_frame(write_packing(frame, "one"));
  const std::string prefix = directory_ / "many";
  write_frame(repeat(one, 2, 3), prefix);
  const Material repeated = make_material(with_packing(source, prefix));
  State a(frame), b(repeated);
  Tensor F;
  F << 0.9995, 0.0004, 0, 0.9990;
  for (const Tensor& deformation : {Tensor(Tensor::Identity()), F}) {
    const Evaluation of_frame = evaluate(a, deformation, 0);
    const Evaluation of_repeated = evaluate(b, deformation, 0);
    ASSERT_EQ(of_frame.status, GRAINLAW_OK);
    ASSERT_EQ(of_repeated.status, GRAINLAW_OK);
    EXPECT_LT(difference(of_repeated.stress, of_frame.stress), 1e-7);
  }
}

TEST_F(dns, one_frame_is_the_point_under_the_same_conditions) {
  const SpecimenScene one = scene("repeat = [1, 1]\n" + biaxial);
  const auto stem = directory_ / "specimen";
  Specimen specimen(one, stem);
  std::vector<Record> records;
  const SpecimenEnd end =
      specimen.run([&](const grainlaw_state*, const Record& record) { records.push_back(record); });
  ASSERT_EQ(end.steps, 4) << end.text;
  // The start is the Cauchy stress that was asked for.
  EXPECT_NEAR(records.front().cauchy(0, 0), -120e3, 1);
  EXPECT_NEAR(records.front().cauchy(1, 1), -120e3, 1);
  const double P11 = records.front().stress(0, 0), F22 = records.front().deformation(1, 1);
  EXPECT_NEAR(records.back().deformation(1, 1), 0.996 * F22, 1e-12);
  EXPECT_NEAR(records.back().stress(0, 0), P11, 1e-6 * std::abs(P11));

  MaterialSource source = with_packing(one.material, stem.string() + "_specimen");
  toml::table boundary = one.sides;
  boundary.insert_or_assign("type", "mixed");
  boundary.insert_or_assign(
      "stress", toml::table{{"P11", P11}, {"P12", 0.0}, {"P22", records.front().stress(1, 1)}});
  source.changes.insert_or_assign("boundary", boundary);
  const Material compressed = make_material(source);
  boundary["stress"].as_table()->erase("P22");
  source.changes.insert_or_assign("boundary", boundary);
  const Material sheared = make_material(source);
  // A state goes over to a material that prescribes another stress, and to no other.
  State start(compressed), point(sheared);
  std::size_t size = 0;
  ASSERT_EQ(grainlaw_state_save(start.get(), nullptr, &size), GRAINLAW_OK);
  std::vector<std::byte> bytes(size);
  ASSERT_EQ(grainlaw_state_save(start.get(), bytes.data(), &size), GRAINLAW_OK);
  ASSERT_EQ(grainlaw_state_load(point.get(), bytes.data(), size), GRAINLAW_OK);
  const State other(make_material(frame_source()));
  EXPECT_EQ(grainlaw_state_load(other.get(), bytes.data(), size), GRAINLAW_WRONG_MATERIAL);
  for (int k = 1; k <= 4; ++k) {
    Tensor F = Tensor::Identity();
    F(1, 1) = F22 * (1 - 0.001 * k);
    const Evaluation evaluation = evaluate(point, F, 0);
    ASSERT_EQ(evaluation.status, GRAINLAW_OK);
    EXPECT_LT(difference(evaluation.stress, records[static_cast<std::size_t>(k)].stress), 1e-6);
    point.commit();
  }
}

TEST_F(dns, flexible_sides_carry_the_stress_and_the_work_is_accounted_for) {
  const auto stem = directory_ / "specimen";
  const SpecimenEnd end = run_specimen(scene("repeat = [1, 2]\n" + biaxial), stem);
  ASSERT_EQ(end.steps, 4) << end.text;
  EXPECT_GT(end.effort.evaluations, 3);
  const CsvTable table = read_csv(stem.string() + ".csv");
  ASSERT_EQ(table.rows(), 5U);
  for (std::size_t k = 0; k < table.rows(); ++k) {
    EXPECT_NEAR(table["P11"][k], table["P11"][0], 1e-6 * std::abs(table["P11"][0]));
    EXPECT_NEAR(table["P12"][k], 0, 1e-6 * std::abs(table["P11"][0]));
  }
  EXPECT_LT(table["sigma22"].back(), 1.1 * table["sigma22"].front());
  const double work = table["external_work"].back();
  const double kept = table["elastic_energy"].back() - table["elastic_energy"].front() +
                      table["dissipated_energy"].back() - table["dissipated_energy"].front();
  EXPECT_NEAR(kept, work, 0.05 * std::abs(work));
}

TEST_F(dns, sides_replace_the_boundary_of_a_material_file_whatever_it_is) {
  std::string file = material.substr(material.find('\n', material.find("[material]")) + 1);
  std::ofstream(directory_ / "plates.toml") << file << R"(
boundary.type = "mixed"
boundary.left = { x = "P", y = "P" }
boundary.right = { x = "P", y = "P" }
boundary.bottom = { x = "D", y = "D" }
boundary.top = { x = "D", y = "D" }
)";
  const SpecimenScene with_file =
      scenes("repeat = [1, 1]\nmaterial = 'plates.toml'\n" + biaxial).front();
  Specimen of_file(with_file, directory_ / "file");
  Specimen of_scene(scene("repeat = [1, 1]\n" + biaxial), directory_ / "scene");
  std::vector<Tensor> stress;
  for (Specimen* specimen : {&of_file, &of_scene})
    specimen->run([&](const grainlaw_state*, const Record& record) {
      if (record.step == 4) stress.push_back(record.stress);
    });
  ASSERT_EQ(stress.size(), 2U);
  EXPECT_EQ(stress[0], stress[1]);
}

TEST_F(dns, bad_scenes_are_refused_with_what_was_expected) {
  const std::string one = "repeat = [1, 1]\n";
  expect_refusal("repeat = [0, 1]\n" + biaxial + material, {"repeat", "an integer from 1 to 100"});
  expect_refusal("repeat = [1.5, 1]\n" + biaxial + material, {"repeat", "an integer"});
  expect_refusal(biaxial + material, {"repeat", "found nothing"});
  expect_refusal(one + material, {"segment", "at least one [[segment]]"});
  expect_refusal(one + "[[segment]]\nsteps = 1\nF22 = 1\nP22 = 0\n" + material,
                 {"scene.toml:5", "segment[1].P22", "one condition per component"});
  expect_refusal(one + "[[segment]]\nsteps = 1\nstretch12 = 1\n" + material,
                 {"stretch12", "stretch11 or stretch22"});
  expect_refusal(one + "[[segment]]\nsteps = 1\nP11 = 'free'\n" + material, {"P11", "held"});
  expect_refusal(one + "[start]\n" + biaxial.substr(biaxial.find("[[")) + material,
                 {"at least one component of the stress"});
  expect_refusal(one + "speed = 1\n" + biaxial + material, {"scene.toml:2", "speed"});
  expect_refusal(one + "[[segment]]\nsteps = 1\n", {"material", "found nothing"});
  expect_refusal(one + biaxial + material + "[[case]]\nname = 'a'\n[[case]]\nname = 'a'\n",
                 {"case[2].name", "no other case has"});
  expect_refusal("seeds = 2\n" + biaxial + material, {"seeds", "one of a [[case]]"});
  expect_refusal(one + "material = 'none.toml'\n[[segment]]\nsteps = 1\n",
                 {"material", "none.toml", "a file that is there"});
}

TEST_F(dns, a_wrong_material_file_is_named) {
  std::ofstream(directory_ / "wrong.toml") << "dimension = 'two'\n";
  expect_refusal("repeat = [1, 1]\nmaterial = 'wrong.toml'\n" + biaxial,
                 {"scene.toml", "wrong.toml", "dimension"});
}

TEST_F(dns, sides_the_library_does_not_know_are_refused) {
  const SpecimenScene wrong = scene("repeat = [1, 1]\nsides.left = { x = 'Q' }\n" + biaxial);
  Specimen specimen(wrong, directory_ / "refused");
  try {
    specimen.run({});
    ADD_FAILURE() << "nothing was refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("left"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace verification
