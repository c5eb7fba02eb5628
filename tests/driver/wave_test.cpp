// Waves through rows of discs: particles against closed forms, meshes against particles.

#include "../data.hpp"
#include "dynamics/motion.hpp"
#include "material/material_file.hpp"
#include "wave/run.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace verification {

using grainlaw::core::WaveSpecimen;

namespace {

const std::string scenes = grainlaw::test::data_file("../../verification/scenes/liu2018_waves/");
constexpr const char* string_bonds =
    "contact = { law = 'bonded', ratio = 0.4, friction = 0, bond.normal_strength = 3e6, "
    "bond.tangential_strength = 6e6 }";

// A string of 2 repeat + 1 discs unless the text says otherwise.
WaveScene parse(const std::string& text) {
  SceneFile file(scenes + "figure_4_4.toml");
  file.content = toml::parse(text).table();
  return read_wave_scene(file);
}

std::string string_scene(const std::string& material, const std::string& rest) {
  return "material = { file = 'pack_string.toml', " + material + " }\n" +
         "duration = 1e-3\npulse = { amplitude = 1e-4, period = 1e-3 }\nrows = 50\nthreads = 1\n" +
         rest;
}

WaveCase short_string(double time_step, const std::string& rest = "") {
  return parse(string_scene(string_bonds, "repeat = 5\nsections = [4.4e-3, 11e-3]\ntime_step = " +
                                              fmt::format("{}", time_step) + "\n" + rest))
      .cases.front();
}

// Discs 1..n-1 between a fixed one and one that moves by A sin(W t), at rest at first: modes with
// the frequencies of the dispersion relation w = 2 sqrt(k / M) sin(q R), q R = m pi / 2n.
double string_of_discs(int n, int disc, double amplitude, double drive, double time) {
  const double mass = 2000 * std::numbers::pi * 1.1e-3 * 1.1e-3 * 1e-3;
  const double kn = 1e4;
  double u = 0;
  for (int m = 1; m < n; ++m) {
    const double omega = 2 * std::sqrt(kn / mass) * std::sin(m * std::numbers::pi / (2 * n));
    const auto shape = [&](int j) {
      return std::sqrt(2.0 / n) * std::sin(m * std::numbers::pi * j / n);
    };
    const double response = (std::sin(drive * time) - drive / omega * std::sin(omega * time)) /
                            (omega * omega - drive * drive);
    u += shape(disc) * kn / mass * shape(n - 1) * amplitude * response;
  }
  return u;
}

TEST(wave, a_string_follows_its_dispersion_relation) {
  const WaveCase one = short_string(1e-7);
  const WaveRun run = run_particles(one);
  ASSERT_EQ(run.particles, 11U);
  const double drive = 2 * std::numbers::pi / one.pulse.period;
  for (const WaveRow& row : run.rows) {
    if (row.time > 0.5 * one.pulse.period) break;
    EXPECT_NEAR(row.displacement[0], string_of_discs(10, 8, 1e-4, drive, row.time), 1e-9);
    EXPECT_NEAR(row.displacement[1], string_of_discs(10, 5, 1e-4, drive, row.time), 1e-9);
  }
}

TEST(wave, energy_of_bonded_discs_is_conserved) {
  const WaveRun run = run_particles(short_string(1e-6));
  for (const WaveRow& row : run.rows)
    EXPECT_NEAR(row.kinetic + row.stored, row.work, 1e-12 * run.rows.back().work + 1e-20);
  EXPECT_GT(run.rows.back().work, 0);
}

TEST(wave, a_mesh_with_an_element_per_disc_is_the_string) {
  const WaveCase one = short_string(1e-6, "mesh = { divisions = [10], time_step = 1e-6 }");
  const WaveRun particles = run_particles(one);
  const WaveRun mesh = run_mesh(one, wave_domain(one), 10);
  ASSERT_EQ(mesh.steps, particles.steps);
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_LT(difference(mesh, particles, k, one.pulse.amplitude).largest, 1e-8);
}

TEST(wave, without_bonds_too) {
  const WaveCase one = parse(string_scene("contact.kn = 1e4",
                                          "repeat = 5\nsections = [4.4e-3]\ntime_step = 1e-6\n"
                                          "mesh = { divisions = [10], time_step = 1e-6 }"))
                           .cases.front();
  const WaveRun particles = run_particles(one);
  const WaveRun mesh = run_mesh(one, wave_domain(one), 10);
  EXPECT_LT(difference(mesh, particles, 0, one.pulse.amplitude).largest, 1e-8);
  EXPECT_LT(particles.rows.back().contacts, 10);  // nothing pulls the discs back
  EXPECT_NEAR(particles.rows.back().kinetic + particles.rows.back().stored,
              particles.rows.back().work, 1e-3 * particles.rows.back().work);
}

TEST(wave, broken_bonds_dissipate_what_they_held) {
  for (const std::string springs :
       {"", "bond.normal_stiffness = 2e4, bond.tangential_stiffness = 8e3, "}) {
    const WaveCase one =
        parse(string_scene("contact = { law = 'bonded', ratio = 0.4, friction = 0, " + springs +
                               "bond.normal_strength = 0.1, bond.tangential_strength = 6e6 }",
                           "repeat = 5\nsections = [4.4e-3]\ntime_step = 1e-7\n"))
            .cases.front();
    const WaveRun run = run_particles(one);
    const WaveRow& end = run.rows.back();
    EXPECT_GT(end.dissipated, 0);
    // The force jumps within a time step: an error of first order in it.
    EXPECT_NEAR(end.kinetic + end.stored + end.dissipated, end.work, 2e-3 * end.work) << springs;
  }
}

TEST(wave, volumes_in_a_row_are_the_specimens_of_the_thesis) {
  const auto material = grainlaw::core::make_material<2>(
      grainlaw::core::read_material_file(scenes + "pack_regular.toml"));
  EXPECT_EQ(repeat_along_x(*material, 40).size(), 9615U);
  const WaveSpecimen specimen = repeat_along_x(*material, 26);
  EXPECT_EQ(specimen.size(), 6255U);
  EXPECT_NEAR(specimen.length, 0.7926, 5e-5);
  // Shared rows and ends: it weighs what its volumes weigh, but for half a column at either end.
  double mass = 0;
  for (std::size_t p = 0; p < specimen.size(); ++p) mass += specimen.mass[p];
  const double volume = specimen.length * specimen.height * specimen.thickness;
  EXPECT_NEAR(mass, mean_density(*material) * volume * 417 / 416, 1e-12 * mass);
}

TEST(wave, a_wrong_scene_is_told) {
  const auto refuses = [](const std::string& text, const std::string& part) {
    try {
      for (const WaveCase& one : parse(text).cases) run_particles(one);
      ADD_FAILURE() << "nobody minded " << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  const std::string right = "repeat = 5\nsections = [4.4e-3]\ntime_step = 1e-6\n";
  refuses(string_scene(string_bonds, right + "periode = 1\n"), "periode");
  refuses(string_scene(string_bonds, "repeat = 0\nsections = [0]\ntime_step = 1e-6\n"), "repeat");
  refuses(string_scene(string_bonds, "repeat = 5\nsections = [1]\ntime_step = 1e-6\n"), "sections");
  refuses(string_scene(string_bonds, "repeat = 5\nsections = [0]\ntime_step = 1e-3\n"),
          "time_step");
  refuses(string_scene(string_bonds, right + "mesh = { divisions = [2.5], time_step = 1e-6 }\n"),
          "divisions");
  refuses(string_scene(string_bonds, right + "[[window]]\nfrom = 1e-3\nto = 0.5e-3\n"), "window");
  refuses(string_scene(string_bonds, right + "[[window]]\nfrom = 1e-3\nto = 1\n"), "window.to");
  refuses(string_scene("contact.kn = -1", right), "kn");
}

}  // namespace
}  // namespace verification
