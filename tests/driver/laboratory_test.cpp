// Element tests of discs and spheres: what each of them keeps, where it turns and where it stops.
#include "point/laboratory_test.hpp"

#include "../temporary_directory.hpp"
#include "app/history.hpp"
#include "point/ensemble.hpp"
#include "point/figures.hpp"
#include "point/run.hpp"
#include "point/scene.hpp"
#include "scene_text.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

namespace verification {
namespace {

const std::string few_spheres = R"(
[material]
dimension = 3
packing = { generator = "compaction", count = 30, radii = [4e-3, 6e-3], seed = 2, pressure = 1e5 }
contact = { law = "frictional", young = 1e8, ratio = 0.8, friction = 0.5 }
)";

class laboratory_test : public testing::Test {
 protected:
  PointScene read(const std::string& text, const std::string& material = small_packing) {
    const std::filesystem::path path = directory_.path() / "scene.toml";
    std::ofstream(path) << "figure = false\n" << material << text;
    return read_point_scenes(SceneFile(path)).front();
  }

  // The records of a path and how its last test ended.
  template <int D>
  std::vector<RecordOf<D>> path(const std::string& segments, TestEnd* end = nullptr) {
    const PointScene scene = read(segments, D == 3 ? few_spheres : small_packing);
    PointDriverOf<D> driver(make_material(scene.material, D), scene.options);
    std::vector<RecordOf<D>> records{driver.record()};
    for (const Segment& segment : scene.segments) {
      const TestEnd one =
          driver.run(segment, [&](const PointStepOf<D>& step) { records.push_back(step.record); });
      if (end != nullptr) *end = one;
    }
    return records;
  }

  void expect_refused(const std::string& text, const std::string& told) {
    try {
      read("[[segment]]\n" + text);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(told), std::string::npos) << error.what();
    }
  }

  const grainlaw::test::TemporaryDirectory directory_;
};

template <int D>
double largest_change_of_volume(const std::vector<RecordOf<D>>& records) {
  double largest = 0;
  for (const RecordOf<D>& record : records)
    largest = std::max(largest, std::abs(record.deformation.determinant() - 1));
  return largest;
}

TEST_F(laboratory_test, undrained_keeps_det_F_at_1_to_1e_12) {
  const std::string test = "[[segment]]\ntest = 'undrained'\nstrain = 0.02\n";
  const auto discs = path<2>(test);
  const auto spheres = path<3>(test);
  EXPECT_GT(discs.size(), 10U);
  EXPECT_GT(spheres.size(), 10U);
  const double of_discs = largest_change_of_volume<2>(discs);
  const double of_spheres = largest_change_of_volume<3>(spheres);
  RecordProperty("largest_of_discs", std::to_string(1e15 * of_discs) + "e-15");
  RecordProperty("largest_of_spheres", std::to_string(1e15 * of_spheres) + "e-15");
  EXPECT_LT(of_discs, 1e-12);
  EXPECT_LT(of_spheres, 1e-12);
}

TEST_F(laboratory_test, undrained_loops_keep_det_F_at_1_to_1e_12) {
  const auto records = path<2>(
      "[[segment]]\ntest = 'undrained'\ncycles = 2\namplitude = { strain = 2e-3 }\nsteps = 4\n");
  EXPECT_EQ(records.size(), 1U + 2 * 4 * 4);
  EXPECT_LT(largest_change_of_volume<2>(records), 1e-12);
  EXPECT_NEAR(records.back().axial_strain(), 0, 1e-12);
}

TEST_F(laboratory_test, a_stress_may_be_prescribed_while_the_volume_is_kept) {
  const auto records =
      path<3>("[[segment]]\nsteps = 5\ndF33 = -0.005\nsigma11 = 'sigma22'\nisochoric = true\n");
  EXPECT_LT(largest_change_of_volume<3>(records), 1e-12);
  const auto& end = records.back();
  EXPECT_NEAR(end.cauchy(0, 0), end.cauchy(1, 1), 1e-5 * end.mean_pressure());
}

TEST_F(laboratory_test, constant_p_keeps_the_mean_pressure) {
  const std::string test = "[[segment]]\ntest = 'constant_p'\nstrain = 0.01\n";
  const auto discs = path<2>(test);
  EXPECT_NEAR(discs.back().mean_pressure() / discs.front().mean_pressure(), 1, 1e-6);
  EXPECT_NE(discs.back().axial_stress(), discs.back().lateral_stress());
  const auto spheres = path<3>(test);
  const auto difference = [](const RecordOf<3>& record) {
    return record.cauchy(1, 1) - record.cauchy(0, 0);
  };
  EXPECT_NEAR(spheres.back().mean_pressure() / spheres.front().mean_pressure(), 1, 1e-6);
  EXPECT_NEAR(difference(spheres.back()), difference(spheres.front()), 1);
}

TEST_F(laboratory_test, a_mean_pressure_may_be_prescribed_beside_a_free_stretch) {
  const auto records =
      path<2>("[[segment]]\nsteps = 4\nF22 = 0.996\nF11 = 'free'\nmean_pressure = 120e3\n");
  EXPECT_NEAR(records.back().mean_pressure(), 120e3, 1);
}

TEST_F(laboratory_test, isotropic_and_k0_lead_to_their_stress) {
  const auto isotropic =
      path<3>("[[segment]]\ntest = 'isotropic'\npressure = 150e3\nsteps = 4\n").back();
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(isotropic.cauchy(i, i), -150e3, 1);
  const auto k0 = path<2>("[[segment]]\ntest = 'k0'\naxial_stress = 150e3\nsteps = 4\n").back();
  EXPECT_NEAR(k0.axial_stress(), 150e3, 1);
  EXPECT_EQ(k0.deformation(0, 0), 1);
  EXPECT_LT(k0.lateral_stress(), 150e3);
  const auto looped =
      path<2>("[[segment]]\ntest = 'isotropic'\npressure = 150e3\nsteps = 4\ncycles = 2\n");
  EXPECT_EQ(looped.size(), 1U + 4 * 4);
  EXPECT_NEAR(looped.back().mean_pressure(), 1e5, 1);
}

TEST_F(laboratory_test, drained_starts_where_consolidation_ended) {
  const auto records = path<2>(
      "[[segment]]\ntest = 'isotropic'\npressure = 150e3\nsteps = 4\n"
      "[[segment]]\ntest = 'drained'\nstrain = 0.01\nsteps = 10\n");
  const double consolidated = records[4].deformation(1, 1);
  EXPECT_NEAR(records.back().lateral_stress(), 150e3, 1);
  EXPECT_NEAR(records.back().deformation(1, 1), consolidated * 0.99, 1e-12);
}

TEST_F(laboratory_test, shears_keep_their_volume_or_the_stress_on_their_planes) {
  const std::string end = "\nstrain = 0.01\n";
  const auto volume = path<3>("[[segment]]\ntest = 'shear_constant_volume'" + end);
  EXPECT_EQ(volume.back().deformation(0, 2), 0.01);
  EXPECT_EQ(volume.back().deformation(2, 2), 1);
  const auto stress = path<2>("[[segment]]\ntest = 'shear_constant_stress'" + end);
  EXPECT_NEAR(stress.back().axial_stress() / stress.front().axial_stress(), 1, 1e-6);
  EXPECT_EQ(stress.back().deformation(0, 0), 1);
}

// q at every turn, as it was asked for, on the step that a test has by itself and on others.
template <int D>
void expect_turns(const std::vector<RecordOf<D>>& records, int cycles, double amplitude) {
  const auto q = [&](std::size_t k) {
    return records[k].axial_stress() - records[k].lateral_stress() -
           (records[0].axial_stress() - records[0].lateral_stress());
  };
  std::vector<double> turns;
  for (std::size_t k = 1; k + 1 < records.size(); ++k)
    if ((records[k].axial_strain() - records[k - 1].axial_strain()) *
            (records[k + 1].axial_strain() - records[k].axial_strain()) <
        0)
      turns.push_back(q(k));
  turns.push_back(q(records.size() - 1));
  ASSERT_EQ(turns.size(), static_cast<std::size_t>(2 * cycles + 1));
  for (std::size_t k = 0; k + 1 < turns.size(); ++k)
    EXPECT_NEAR(turns[k], k % 2 == 0 ? amplitude : -amplitude, 1e-6 * amplitude) << k;
  EXPECT_NEAR(turns.back(), 0, 1e-6 * amplitude);
}

TEST_F(laboratory_test, loops_between_stresses_turn_at_them) {
  const std::string loops = "cycles = 2\namplitude = { q = 20e3 }\n";
  for (const char* step : {"", "step = 2e-4\n"}) {
    expect_turns<2>(path<2>(std::string("[[segment]]\ntest = 'drained'\n") + loops + step), 2,
                    20e3);
    expect_turns<3>(path<3>(std::string("[[segment]]\ntest = 'undrained'\n") + loops + step), 2,
                    20e3);
  }
}

TEST_F(laboratory_test, a_step_that_may_not_stay_is_taken_back) {
  const PointScene scene = read("[[segment]]\nsteps = 1\ndF22 = -1e-3\n");
  const Material material = make_material(scene.material);
  PointDriver driver(material, scene.options), straight(material, scene.options);
  const Segment& step = scene.segments[0];
  int seen = 0;
  const auto observe = [&](const PointStep&) { ++seen; };
  EXPECT_FALSE(driver.run_steps(step, observe, {}, [](const Record&) { return false; }));
  EXPECT_EQ(seen, 0);
  EXPECT_EQ(driver.record().step, 0);
  EXPECT_TRUE(driver.run_steps(step, observe, {}, [](const Record&) { return true; }));
  straight.run_steps(step, {});
  EXPECT_EQ(seen, 1);
  EXPECT_EQ(driver.record().stress, straight.record().stress);
  EXPECT_EQ(driver.record().effort.evaluations, 2 * straight.record().effort.evaluations);
}

TEST_F(laboratory_test, b_keeps_the_intermediate_stress_between_the_others) {
  for (const char* test : {"drained", "constant_p", "undrained"}) {
    const auto records = path<3>(std::string("[[segment]]\ntest = '") + test +
                                 "'\nb = 0.3\nstrain = 0.005\nsteps = 5\n");
    const auto& sigma = records.back().cauchy;
    EXPECT_LT(sigma(2, 2), 1.05 * sigma(0, 0)) << test;
    EXPECT_NEAR((sigma(1, 1) - sigma(0, 0)) / (sigma(2, 2) - sigma(0, 0)), 0.3, 1e-4) << test;
  }
  EXPECT_LT(largest_change_of_volume<3>(
                path<3>("[[segment]]\ntest = 'undrained'\nb = 1\nstrain = 0.002\nsteps = 2\n")),
            1e-12);
}

TEST_F(laboratory_test, stops_where_it_is_asked_to) {
  const auto stop = [&](const std::string& at) {
    TestEnd end;
    path<2>("[[segment]]\ntest = 'drained'\nstrain = 0.02\nstop = { " + at + " }\n", &end);
    return end.text;
  };
  EXPECT_EQ(stop("strain = 5e-3"), "strain 0.005 reached");
  EXPECT_EQ(stop("q = 20e3").rfind("q ", 0), 0U);
  EXPECT_EQ(stop("ratio = 0.2").rfind("q/p 0.", 0), 0U);
  EXPECT_EQ(stop("p = 105e3").rfind("mean pressure 1", 0), 0U);
  EXPECT_EQ(stop("axial_stress = 120e3").rfind("axial stress 1", 0), 0U);
  EXPECT_EQ(stop("q = 1e9"), "");
}

TEST_F(laboratory_test, ends_when_nothing_carries_any_more) {
  TestEnd end;
  const auto records = path<2>(
      "[[segment]]\ntest = 'oedometric'\nstrain = -0.05\nstop = { liquefied = 0.02 }\n", &end);
  EXPECT_TRUE(end.liquefied);
  EXPECT_EQ(end.text.rfind("liquefied: ", 0), 0U) << end.text;
  EXPECT_LT(records.size(), 90U);
}

TEST_F(laboratory_test, refuses_what_it_does_not_know) {
  expect_refused("test = 'triaxial'\n", "one of isotropic, oedometric, k0, drained, undrained");
  expect_refused("test = 'drained'\npressure = 1e5\n", "pressure");
  expect_refused("test = 'drained'\nstrain = 5\n", "a strain between -0.5 and 0.5");
  expect_refused("test = 'drained'\nsteps = 3\nstep = 1e-3\n", "one of the two");
  expect_refused("test = 'drained'\nstep = 1e-12\n", "found 1e+11 steps over a strain of 0.1");
  expect_refused("test = 'drained'\ncycles = 3\n", "amplitude");
  expect_refused("test = 'drained'\namplitude = { q = 1e3 }\n", "one beside cycles");
  expect_refused("test = 'drained'\nstop = { f = 1.0 }\n", "stop.f");
  expect_refused("test = 'drained'\nb = 2\n", "from 0 to 1");
  expect_refused("test = 'drained'\nb = 0.5\n", "b: found two dimensions");
  expect_refused("test = 'isotropic'\nb = 0.5\n", "b: found an unknown key");
  expect_refused("steps = 1\nsigma11 = 'sigma33'\n", "the name of another stress");
  expect_refused("steps = 1\nsigma11 = 'sigma22'\nsigma22 = 'sigma11'\n",
                 "which equals sigma11 itself");
  expect_refused("steps = 1\nsigma12 = 'sigma21'\n", "which equals sigma12 itself");
  expect_refused("steps = 1\nF11 = 'free'\n", "beside mean_pressure");
  expect_refused("steps = 1\nmean_pressure = 1e5\n", "0 components of F");
  expect_refused("steps = 1\nF22 = 0.99\nF11 = 1.01\nisochoric = true\n", "all of the diagonal");
}

TEST_F(laboratory_test, pictures_of_a_test_are_those_of_soil_mechanics) {
  const PointScene compression = read("[[segment]]\ntest = 'k0'\n");
  EXPECT_EQ(compression.figures, std::vector<std::string>{"e-log-p"});
  const PointScene shear = read("[[segment]]\ntest = 'shear_constant_volume'\n");
  EXPECT_EQ(shear.figures, std::vector<std::string>{"p-q"});
  EXPECT_EQ(shear.abscissa, shear_abscissa);
  EXPECT_EQ(figure_end("e-log-p"), "_e_log_p");
}

TEST_F(laboratory_test, another_law_in_a_case_takes_over_what_it_knows) {
  const PointScene scene = read(
      "[[case]]\nname = 'hertz'\n"
      "material = { contact = { law = 'hertz', shear_modulus = 29e9, poisson = 0.2 } }\n"
      "segment = [{ test = 'drained', strain = 0.002, steps = 2 }]\n");
  PointEnd end;
  run_point(scene, directory_.path() / "hertz", end);
  EXPECT_EQ(end.steps, 2);
  EXPECT_EQ(scene.material.changes["contact"]["friction"].value_or(0.0), 0.5);
  EXPECT_FALSE(scene.material.changes["contact"].as_table()->contains("young"));
}

TEST_F(laboratory_test, drag_is_a_column_of_a_law_in_time_alone_and_told_where_it_is_much) {
  const auto run = [&](double number) {
    PointScene scene = read("[[segment]]\ntest = 'drained'\nstrain = 0.04\nsteps = 20\n");
    change(scene.material, "solver", "viscous_number", number);
    PointEnd end;
    testing::internal::CaptureStdout();
    run_point(scene, directory_.path() / "drag", end);
    return std::pair(testing::internal::GetCapturedStdout(),
                     read_csv(directory_.path() / "drag.csv"));
  };
  const auto has = [](const CsvTable& table) {
    return std::find(table.names.begin(), table.names.end(), "unbalanced") != table.names.end();
  };
  EXPECT_FALSE(has(run(0).second));
  const auto [out, table] = run(0.3);
  ASSERT_TRUE(has(table));
  const auto& drag = table["unbalanced"];
  const auto much =
      std::count_if(drag.begin(), drag.end(), [](double value) { return value > much_drag; });
  EXPECT_GT(much, 0);
  EXPECT_NE(out.find(fmt::format("above 0.1 in {} steps", much)), std::string::npos) << out;
}

TEST_F(laboratory_test, an_ensemble_is_the_mean_of_its_packings_and_how_far_they_spread) {
  const std::filesystem::path path = directory_.path() / "many.toml";
  std::ofstream(path) << "figure = false\n"
                      << small_packing
                      << "[[case]]\nname = 'a'\nseeds = 3\n"
                         "segment = [{ test = 'drained', strain = 0.002, steps = 2 }]\n";
  const SceneFile file(path);
  double sum = 0, squares = 0;
  for (const PointScene& scene : read_point_scenes(file)) {
    PointEnd end;
    run_point(scene, directory_.path() / scene.name, end);
    const double ratio = read_csv(directory_.path() / (scene.name + ".csv"))["stress_ratio"].back();
    sum += ratio / 3;
    squares += ratio * ratio / 3;
  }
  const auto ensembles = ensembles_of(file, "many");
  ASSERT_EQ(ensembles.size(), 1U);
  write_ensemble(ensembles[0], directory_.path(), axial_abscissa, false);
  const CsvTable table = read_csv(directory_.path() / "many_a_ensemble.csv");
  EXPECT_EQ(table["runs"].back(), 3);
  EXPECT_NEAR(table["stress_ratio"].back(), sum, 1e-9);
  EXPECT_NEAR(table["sd_stress_ratio"].back(), std::sqrt(1.5 * (squares - sum * sum)), 1e-6);
}

}  // namespace
}  // namespace verification
