// Runs that go on from a checkpoint, against runs that were never interrupted.
#include "../temporary_directory.hpp"
#include "app/interrupt.hpp"
#include "fe/run.hpp"
#include "scene_text.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <iterator>

namespace verification {
namespace {

using grainlaw::test::TemporaryDirectory;

// With a table of a point, series for ParaView of the mesh and of a packing.
const std::string specimen =
    "steps = 4\nthreads = 1\nvtk_every = 2\npackings = [1]\npoints = [2]\n" + small_packing;
const std::string compression = "[newton]\ntolerance = 1e-6\n" + narrow_mesh + smooth_supports + R"(
[[displacement]]
on = "top"
component = "y"
value = -3e-3

[[pressure]]
on = "right"
value = 100e3
)";

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class restart : public testing::Test {
 protected:
  void write_scene(const std::string& text) const { std::ofstream(scene()) << text; }
  // Runs the scene with results in directory / name.
  void run(const std::string& name, bool again = false, std::optional<int> stop_after = {}) const {
    run_fe_scene(SceneFile(scene()),
                 {{(directory_.path() / name).string()}, again, {}, stop_after});
  }
  // What it says when it refuses to.
  [[nodiscard]] std::string refusal(const std::string& name) const {
    try {
      run(name, true);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing was refused";
  }
  [[nodiscard]] std::filesystem::path scene() const { return directory_.path() / "s.toml"; }
  [[nodiscard]] std::filesystem::path file(const std::string& run, const std::string& name) const {
    return directory_.path() / run / name;
  }
  // All but times and pictures, which are drawn from the tables.
  void expect_same_files(const std::string& expected, const std::string& found) const {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(directory_.path() / expected)) {
      const std::string name = entry.path().filename().string();
      if (entry.is_directory()) continue;  // the list of what was written
      if (name == "s_cost.csv" || entry.path().extension() == ".checkpoint") continue;
      EXPECT_TRUE(contents(entry.path()) == contents(file(found, name))) << name;
      ++files;
    }
    EXPECT_GE(files, 6);
  }
  void expect_same_files_in_pieces() const {
    run("whole");
    run("pieces", false, 0);
    run("pieces", true, 3);
    run("pieces", true);
    expect_same_files("whole", "pieces");
  }

  TemporaryDirectory directory_;
};

TEST_F(restart, ends_in_the_bytes_of_an_uninterrupted_run) {
  write_scene(specimen + compression);
  expect_same_files_in_pieces();
}

TEST_F(restart, that_guesses_the_last_move_ends_in_the_same_bytes) {
  std::string guessing = specimen + compression;
  guessing.insert(guessing.find("[newton]\n") + 9, "first_guess = \"last_move\"\n");
  write_scene(guessing);
  expect_same_files_in_pieces();
}

TEST_F(restart, of_a_dynamic_run_ends_in_the_same_bytes) {
  write_scene("solver = \"dynamics\"\n" + specimen +
              "[dynamics]\ndensity = 2000\nduration = 1e-3\n" + narrow_mesh + held_bottom + R"(
[[displacement]]
on = "top"
component = "y"
value = -1e-5
)");
  expect_same_files_in_pieces();
}

TEST_F(restart, of_dynamic_relaxation_ends_in_the_same_bytes) {
  std::string relaxed = "solver = \"relaxation\"\n" + specimen + compression;
  relaxed.replace(relaxed.find("[newton]"), 8, "[relaxation]");
  write_scene(relaxed);
  expect_same_files_in_pieces();
}

TEST_F(restart, with_platens_periodic_sides_and_resultants_ends_in_the_same_bytes) {
  write_scene(specimen + narrow_mesh + held_bottom + periodic_sides + R"(
[[tie]]
on = "top"
component = "y"

[[resultant]]
on = "top"
component = "y"
start = -50e3
value = -52e3

[[tie]]
on = "top"
component = "x"

[[resultant]]
on = "top"
component = "x"
value = 1e3
)");
  expect_same_files_in_pieces();
}

TEST_F(restart, with_a_platen_on_a_hinge_ends_in_the_same_bytes) {
  write_scene(specimen + "[newton]\ntolerance = 1e-6\n" + narrow_mesh + "element = 'q4'\n" +
              held_bottom + R"(
[[platen]]
on = "top"
surface = "rough"
rotation = "free"
hinge = 0.2

[[displacement]]
on = "top"
component = "y"
path = [[0, 0], [0.4, -2e-3], [1, -1e-3]]

[[pressure]]
on = "right"
value = 100e3

[[pressure]]
on = "left"
value = 100e3
)");
  expect_same_files_in_pieces();
}

TEST_F(restart, of_a_cyclic_test_ends_in_the_same_bytes) {
  write_scene("abscissa = \"F12\"\n" + specimen + narrow_mesh + held_bottom + R"(
[cycle]
on = "top"
step = 5e-4
limit_displacement = 1e-3
cycles = 1
)" + held("top", "y") +
              periodic_sides);
  expect_same_files_in_pieces();
}

TEST_F(restart, drops_what_came_after_the_checkpoint) {
  write_scene(specimen + compression);
  run("whole");
  run("killed", false, 1);
  const std::string checkpoint = contents(file("killed", "s.checkpoint"));
  run("killed", true, 3);
  std::ofstream(file("killed", "s.checkpoint"), std::ios::binary) << checkpoint;
  std::ofstream(file("killed", "s.csv"), std::ios::app) << "4,half of a ro";
  run("killed", true);
  expect_same_files("whole", "killed");
}

TEST_F(restart, without_a_checkpoint_starts_anew_and_after_the_end_changes_nothing) {
  write_scene(specimen + compression);
  run("whole");
  run("again", true);
  expect_same_files("whole", "again");
  run("again", true);
  expect_same_files("whole", "again");
}

TEST_F(restart, of_another_scene_material_or_table_is_refused) {
  write_scene(specimen + compression);
  run("run", false, 1);
  const std::string checkpoint = contents(file("run", "s.checkpoint"));

  std::string changed = specimen + compression;
  changed.replace(changed.find("-3e-3"), 5, "-2e-3");
  write_scene(changed);
  EXPECT_NE(refusal("run").find("found `value = -0.002` now, expected `value = -0.003"),
            std::string::npos)
      << refusal("run");

  write_scene("checkpoint_every = 7\n" + specimen + compression);
  std::filesystem::resize_file(file("run", "s_force.csv"), 10);
  EXPECT_NE(refusal("run").find("s_force.csv"), std::string::npos) << refusal("run");
  std::filesystem::remove(file("run", "s_force.csv"));
  EXPECT_NE(refusal("run").find("s_force.csv"), std::string::npos) << refusal("run");
  EXPECT_EQ(contents(file("run", "s.checkpoint")), checkpoint);
}

TEST(interrupt, notes_the_first_signal_and_ends_at_the_second) {
  {
    const Interrupt interrupt;
    EXPECT_EQ(Interrupt::signal(), 0);
    std::raise(SIGTERM);
    EXPECT_EQ(Interrupt::signal(), SIGTERM);
    EXPECT_THROW(Interrupt::check(), Interrupted);
  }
  Interrupt::check();  // of the next command nothing was asked
  EXPECT_EXIT(
      {
        const Interrupt interrupt;
        std::raise(SIGINT);
        std::raise(SIGINT);
      },
      testing::KilledBySignal(SIGINT), "");
}

}  // namespace
}  // namespace verification
