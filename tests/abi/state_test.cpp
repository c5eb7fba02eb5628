// One integration point: what an evaluation, a commit, a revert, a copy and saved bytes keep, and
// what files tell of it.
#include "continue_saved.hpp"
#include "support.hpp"

#include <cfenv>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace grainlaw::test {
namespace {

TEST(state, same_F_gives_same_bits) {
  State state(material());
  Tensor P1{}, P2{};
  Tangent A1{}, A2{};
  ASSERT_TRUE(state.evaluate(compressed, P1, GRAINLAW_WANT_TANGENT_EXACT, A1));
  stress(state, further);
  ASSERT_TRUE(state.evaluate(compressed, P2, GRAINLAW_WANT_TANGENT_EXACT, A2));
  EXPECT_TRUE(same_bits(P1, P2));
  EXPECT_TRUE(same_bits(A1, A2));
}

TEST(state, revert_restores_bits) {
  State state(material());
  stress(state, compressed);
  state.commit();
  const auto committed = state.save();
  const auto before = state.measure(GRAINLAW_CAUCHY_STRESS);
  stress(state, further);
  EXPECT_FALSE(same_bits(before, state.measure(GRAINLAW_CAUCHY_STRESS)));
  state.revert();
  EXPECT_TRUE(same_bits(before, state.measure(GRAINLAW_CAUCHY_STRESS)));
  EXPECT_TRUE(same_bits(committed, state.save()));
}

TEST(state, commit_makes_the_trial_the_start_of_the_next_increment) {
  State state(material());
  stress(state, compressed);
  state.commit();
  const Tensor continued = stress(state, further);
  State fresh(material());
  EXPECT_FALSE(same_bits(continued, stress(fresh, further)));
  EXPECT_EQ(grainlaw_commit(state.get()), GRAINLAW_OK);
}

TEST(state, commit_without_a_trial_is_refused) {
  State state(material());
  EXPECT_EQ(grainlaw_commit(state.get()), GRAINLAW_NO_TRIAL);
  stress(state, compressed);
  state.commit();
  EXPECT_EQ(grainlaw_commit(state.get()), GRAINLAW_NO_TRIAL);
  stress(state, further);
  state.revert();
  EXPECT_EQ(grainlaw_commit(state.get()), GRAINLAW_NO_TRIAL);
}

TEST(state, clone_has_the_trial_and_is_independent) {
  State state(material());
  stress(state, compressed);
  State clone(state);
  clone.commit();
  EXPECT_FALSE(same_bits(clone.save(), state.save()));
  state.commit();
  EXPECT_TRUE(same_bits(clone.save(), state.save()));
  EXPECT_TRUE(same_bits(stress(clone, further), stress(state, further)));
}

TEST(state, without_contacts_is_kept_where_the_material_takes_it_as_free_of_stress) {
  std::string text = read_text(material_path);
  text += "[solver]\ncontacts_lost = \"stress_free\"\n";
  const Material made = Material::parse(text.c_str(), data_directory.c_str());
  State state(made);
  const Tensor wide{1.1, 0, 0, 1.1};
  Tensor P{};
  Tangent A{};
  grainlaw_report report = grainlaw_report_default();
  A.fill(1);
  ASSERT_EQ(grainlaw_evaluate(state.get(), wide.data(), GRAINLAW_WANT_TANGENT_EXACT, P.data(),
                              A.data(), &report),
            GRAINLAW_OK);
  EXPECT_EQ(P, Tensor{});
  EXPECT_EQ(A, Tangent{});
  EXPECT_EQ(report.contacts, 0);
  EXPECT_NE(std::string(report.message).find("free of stress"), std::string::npos);
  state.commit();
  const auto saved = state.save();
  State other(made);
  stress(other, compressed);
  ASSERT_EQ(grainlaw_state_load(other.get(), saved.data(), saved.size()), GRAINLAW_OK);
  EXPECT_EQ(other.measure(GRAINLAW_CONTACTS)[0], 0);
  EXPECT_TRUE(same_bits(stress(other, compressed), stress(state, compressed)));
  EXPECT_LT(stress(other, compressed)[3], 0);
  const TemporaryDirectory directory;
  state.revert();
  EXPECT_EQ(grainlaw_state_write_vtk(state.get(), (directory / "free.vtp").string().c_str()),
            GRAINLAW_OK);
  EXPECT_EQ(grainlaw_state_write_packing(state.get(), (directory / "free_").string().c_str()),
            GRAINLAW_OK);
}

TEST(state, outlives_the_handle_of_its_material) {
  grainlaw_material* handle = nullptr;
  ASSERT_EQ(grainlaw_material_load(material_path.c_str(), &handle, nullptr, 0), GRAINLAW_OK);
  grainlaw_state* state = nullptr;
  ASSERT_EQ(grainlaw_state_create(handle, &state), GRAINLAW_OK);
  grainlaw_material_destroy(handle);
  Tensor P{};
  EXPECT_EQ(grainlaw_evaluate(state, compressed.data(), 0, P.data(), nullptr, nullptr),
            GRAINLAW_OK);
  State reference(material());
  EXPECT_TRUE(same_bits(P, stress(reference, compressed)));
  grainlaw_state_destroy(state);
}

TEST(state, loaded_bytes_continue_with_the_same_bits) {
  State state(material());
  stress(state, compressed);
  state.commit();
  const auto bytes = state.save();
  State loaded(material());
  stress(loaded, further);  // a trial that loading drops
  loaded.load(bytes);
  EXPECT_EQ(grainlaw_commit(loaded.get()), GRAINLAW_NO_TRIAL);
  EXPECT_TRUE(same_bits(bytes, loaded.save()));
  EXPECT_TRUE(same_bits(continue_from(state), continue_from(loaded)));
}

TEST(state, bytes_continue_in_a_new_process_with_the_same_bits) {
  State state(material());
  stress(state, compressed);
  state.commit();
  const auto bytes = state.save();
  const TemporaryDirectory directory;
  const auto from = directory / "saved";
  const auto to = directory / "continued";
  write_text(from, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string command =
      "'" + self + "' --continue '" + from.string() + "' '" + to.string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string continued = read_text(to);
  const auto here = continue_from(state);
  ASSERT_EQ(continued.size(), here.size());
  EXPECT_EQ(std::memcmp(continued.data(), here.data(), here.size()), 0);
}

TEST(state, results_do_not_depend_on_the_floating_point_mode_of_the_host) {
  State state(material());
  const Tensor expected = stress(state, compressed);
  std::fenv_t host;
  std::fegetenv(&host);
  for (const int rounding : {FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO}) {
    std::fesetround(rounding);
    const Tensor found = stress(state, compressed);
    EXPECT_EQ(std::fegetround(), rounding);
    EXPECT_TRUE(same_bits(expected, found));
  }
  std::fesetenv(&host);
#ifdef __GLIBC__
  feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
  const Tensor found = stress(state, compressed);
  std::fesetenv(&host);
  EXPECT_TRUE(same_bits(expected, found));
#endif
}

TEST(state, identity_gives_the_stress_of_the_packing) {
  State state(material());
  const Tensor P = stress(state, identity);
  constexpr double pressure = 1e5;  // that the packing was consolidated at [Pa]
  EXPECT_NEAR(P[0], -pressure, 1e-3 * pressure);
  EXPECT_NEAR(P[3], -pressure, 1e-3 * pressure);
}

TEST(state, a_report_tells_what_was_done) {
  State state(material());
  Tensor P{};
  Tangent A{};
  const auto result = state.evaluate(compressed, P, GRAINLAW_WANT_TANGENT_EXACT, A);
  ASSERT_TRUE(result);
  EXPECT_EQ(result.report.size, sizeof(grainlaw_report));
  EXPECT_LE(result.report.residual, 1e-6);
  EXPECT_EQ(result.report.step_ratio, 1);
  EXPECT_GT(result.report.relaxation_steps, 0);
  EXPECT_GE(result.report.subincrements, 1);
  EXPECT_GT(result.report.contacts, 700);
  EXPECT_EQ(result.report.tangent_exact, 1);
  EXPECT_STREQ(result.report.message, "");
}

TEST(state, a_smaller_known_report_is_filled_to_its_size) {
  // Size of the fields of version 0.1, without the padding at the end.
  constexpr std::size_t size = offsetof(grainlaw_report, message) + 256;
  grainlaw_report report;
  std::memset(&report, 0x5a, sizeof report);
  report.size = size;
  State state(material());
  ASSERT_EQ(grainlaw_evaluate(state.get(), compressed.data(), 0, nullptr, nullptr, &report),
            GRAINLAW_OK);
  EXPECT_EQ(report.size, size);
  EXPECT_GT(report.contacts, 0);
  EXPECT_STREQ(report.message, "");
  const auto* bytes = reinterpret_cast<const unsigned char*>(&report);
  for (std::size_t k = size; k < sizeof report; ++k) EXPECT_EQ(bytes[k], 0x5a);
}

TEST(state, a_written_packing_starts_at_the_stress_it_was_written_with) {
  constexpr double tolerance = 1e-5 * 1e5;  // of the pressure [Pa]
  for (const std::string boundary : {"periodic-cell", "frame-p", "frame-d", "frame-t"}) {
    std::string text = read_text(material_path) + "[boundary]\ntype = \"" + boundary + "\"\n";
    State state(Material::parse(text, data_directory));
    stress(state, compressed);
    const TemporaryDirectory directory;
    state.write_packing((directory / "here").string());
    for (const std::string old = "rve400_"; text.find(old) != std::string::npos;)
      text.replace(text.find(old), old.size(), "here_");
    State restarted(Material::parse(text, directory.string()));
    const auto expected = state.measure(GRAINLAW_CAUCHY_STRESS);
    const auto found = restarted.measure(GRAINLAW_CAUCHY_STRESS);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(found[k], expected[k], tolerance) << boundary;
    EXPECT_NEAR(restarted.measure(GRAINLAW_VOID_RATIO)[0], state.measure(GRAINLAW_VOID_RATIO)[0],
                1e-9);
  }
}

// What a file draws: discs, and from the centre of one of each contact's discs the branch.
struct Drawing {
  std::vector<double> x, y, radius, rotation;  // of points
  std::vector<double> normal_force, tangential_force;
  std::vector<std::size_t> first;  // disc of each contact
  std::size_t discs = 0;
};

template <class Number>
std::vector<Number> array_of(const std::string& text, const std::string& name,
                             std::size_t from = 0) {
  std::vector<Number> numbers;
  const auto at = text.find("Name=\"" + name + "\"", from);
  if (at == std::string::npos) return numbers;
  const auto begin = text.find('>', at) + 1;
  std::istringstream values(text.substr(begin, text.find('<', begin) - begin));
  for (Number number; values >> number;) numbers.push_back(number);
  return numbers;
}

Drawing drawing_of(const State& state) {
  const TemporaryDirectory directory;
  state.write_vtk((directory / "state.vtp").string());
  const std::string text = read_text(directory / "state.vtp");
  Drawing drawing;
  const auto points = array_of<double>(text, "points");
  for (std::size_t k = 0; k < points.size(); k += 3) {
    drawing.x.push_back(points[k]);
    drawing.y.push_back(points[k + 1]);
  }
  drawing.radius = array_of<double>(text, "radius");
  drawing.rotation = array_of<double>(text, "rotation");
  drawing.normal_force = array_of<double>(text, "normal_force");
  drawing.tangential_force = array_of<double>(text, "tangential_force");
  const auto lines = array_of<std::size_t>(text, "connectivity", text.find("<Lines>"));
  drawing.discs = drawing.x.size() - lines.size() / 2;
  for (std::size_t k = 0; k < lines.size(); k += 2) {
    drawing.first.push_back(lines[k]);
    EXPECT_EQ(lines[k + 1], drawing.discs + k / 2);
  }
  return drawing;
}

// The disc at a point, or one of its images: F H (whole numbers) away.
std::size_t disc_at(const Drawing& drawing, std::size_t point, const Tensor& cell) {
  const double det = cell[0] * cell[3] - cell[1] * cell[2];
  for (std::size_t p = 0; p < drawing.discs; ++p) {
    const double dx = drawing.x[point] - drawing.x[p];
    const double dy = drawing.y[point] - drawing.y[p];
    const double a = (cell[3] * dx - cell[1] * dy) / det;
    const double b = (cell[0] * dy - cell[2] * dx) / det;
    if (std::hypot(a - std::round(a), b - std::round(b)) < 1e-9) return p;
  }
  ADD_FAILURE() << "no disc where contact " << point - drawing.discs << " ends";
  return 0;
}

void expect_drawn(const State& state) {
  const Drawing drawing = drawing_of(state);
  ASSERT_EQ(static_cast<double>(drawing.discs), state.measure(GRAINLAW_PARTICLES)[0]);
  ASSERT_EQ(static_cast<double>(drawing.first.size()), state.measure(GRAINLAW_CONTACTS)[0]);
  const auto F = state.measure(GRAINLAW_DEFORMATION_GRADIENT);
  constexpr double width = 0.19808721074789126, height = 0.19661172131892471;  // of the cell [m]
  const Tensor cell{F[0] * width, F[1] * height, F[2] * width, F[3] * height};

  const double volume = state.measure(GRAINLAW_VOLUME)[0];
  double rotation = 0, overlap = 0, energy = 0;
  Tensor stress{};
  for (std::size_t p = 0; p < drawing.discs; ++p) {
    rotation += drawing.rotation[p] / static_cast<double>(drawing.discs);
  }
  for (std::size_t k = 0; k < drawing.first.size(); ++k) {
    const std::size_t i = drawing.first[k];
    const std::size_t end = drawing.discs + k;
    const double ri = drawing.radius[i], rj = drawing.radius[disc_at(drawing, end, cell)];
    const double lx = drawing.x[end] - drawing.x[i];
    const double ly = drawing.y[end] - drawing.y[i];
    const double d = std::hypot(lx, ly);
    const double kn = 6e8 * 2 * ri * rj / (ri + rj);  // tests/data/rve400.toml
    const double fn = drawing.normal_force[end], ft = drawing.tangential_force[end];
    EXPECT_NEAR(fn, kn * (ri + rj - d), 1e-7);  // of some 100 N
    overlap += (ri + rj - d) / static_cast<double>(drawing.first.size());
    energy += 0.5 * fn * fn / kn + 0.5 * ft * ft / (0.8 * kn);
    const std::array<double, 2> force{(fn * lx - ft * ly) / d, (fn * ly + ft * lx) / d};
    for (std::size_t m = 0; m < 4; ++m) {
      stress[m] -= force[m / 2] * (m % 2 == 0 ? lx : ly) / volume;
    }
  }
  EXPECT_NEAR(rotation, state.measure(GRAINLAW_MEAN_ROTATION)[0], 1e-12);
  const auto expect_close = [](double found, double expected) {
    EXPECT_NEAR(found, expected, 1e-9 * std::abs(expected));
  };
  expect_close(overlap, state.measure(GRAINLAW_MEAN_OVERLAP)[0]);
  expect_close(energy, state.measure(GRAINLAW_ELASTIC_ENERGY)[0]);
  const auto sigma = state.measure(GRAINLAW_CAUCHY_STRESS);
  for (std::size_t m = 0; m < 4; ++m) EXPECT_NEAR(stress[m], sigma[m], 1e-9 * 1e5);
}

TEST(state, a_vtk_file_draws_the_trial_or_what_is_committed) {
  State state(material());
  stress(state, compressed);
  state.commit();
  const auto committed = state.measure(GRAINLAW_MEAN_OVERLAP);
  stress(state, further);
  EXPECT_GT(state.measure(GRAINLAW_MEAN_OVERLAP)[0], 1.01 * committed[0]);
  expect_drawn(state);
  const Drawing trial = drawing_of(state);
  state.revert();
  EXPECT_EQ(state.measure(GRAINLAW_MEAN_OVERLAP), committed);
  expect_drawn(state);

  // Discs follow F from one to the other, each with a fluctuation of its own.
  const Drawing before = drawing_of(state);
  double off = 0, moved = 0;
  for (std::size_t p = 0; p < before.discs; ++p) {
    const double dx = trial.x[p] - before.x[p] - (further[0] - compressed[0]) * before.x[p] -
                      (further[1] - compressed[1]) * before.y[p];
    const double dy = trial.y[p] - before.y[p] - (further[2] - compressed[2]) * before.x[p] -
                      (further[3] - compressed[3]) * before.y[p];
    off += std::hypot(dx, dy);
    moved += std::hypot(trial.x[p] - before.x[p], trial.y[p] - before.y[p]);
  }
  EXPECT_GT(moved, 0);
  EXPECT_LT(off, 0.5 * moved);
}

TEST(state, every_measure_can_be_asked) {
  State state(material());
#define GRAINLAW_X(name, value, count, text) \
  for (const double number : state.measure(name)) EXPECT_TRUE(std::isfinite(number)) << text;
  GRAINLAW_MEASURE_LIST(GRAINLAW_X)
#undef GRAINLAW_X
  EXPECT_EQ(state.measure(GRAINLAW_PARTICLES), std::vector{400.0});
  EXPECT_EQ(state.measure(GRAINLAW_FABRIC).size(), 4U);
}

TEST(texts, keys_of_material_files_are_listed_with_expectation_and_default) {
  std::size_t size = 0;
  ASSERT_EQ(grainlaw_material_keys(nullptr, &size), GRAINLAW_OK);
  std::string text(size, 'x');
  std::size_t short_size = size - 1;
  EXPECT_EQ(grainlaw_material_keys(text.data(), &short_size), GRAINLAW_BUFFER_TOO_SMALL);
  EXPECT_EQ(text, std::string(size, 'x'));
  ASSERT_EQ(grainlaw_material_keys(text.data(), &size), GRAINLAW_OK);
  ASSERT_EQ(size, text.size());
  EXPECT_EQ(text.back(), '\0');
  EXPECT_EQ(text.find("dimension\t2 (discs) or 3 (spheres)\trequired\n"), 0U);
  EXPECT_NE(text.find("\ncontact.friction\ta number >= 0\t"), std::string::npos);
}

TEST(texts, every_status_has_one) {
#define GRAINLAW_X(name, value, text) EXPECT_STREQ(grainlaw_status_text(name), text);
  GRAINLAW_STATUS_LIST(GRAINLAW_X)
#undef GRAINLAW_X
  EXPECT_STREQ(grainlaw_status_text(static_cast<grainlaw_status>(-16)), "unknown status");
  EXPECT_STREQ(grainlaw_version(), "0.1.0");
}

}  // namespace
}  // namespace grainlaw::test
