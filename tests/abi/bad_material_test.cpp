// Material files with every kind of mistake: the message names file, line, key and expectation.
#include "support.hpp"

#include <sstream>

namespace grainlaw::test {
namespace {

// The good file, one line per key; a case replaces or adds lines.
const std::string good =
    "dimension = 2\n"                         // 1
    "thickness = 0.1\n"                       // 2
    "[packing]\n"                             // 3
    "particles = \"rve400_particles.csv\"\n"  // 4
    "contacts = \"rve400_contacts.csv\"\n"    // 5
    "cell = \"rve400_cell.csv\"\n"            // 6
    "[contact]\n"                             // 7
    "law = \"frictional\"\n"                  // 8
    "young = 6e8\n"                           // 9
    "ratio = 0.8\n"                           // 10
    "friction = 0.5463024898437905\n"         // 11
    "[boundary]\n"                            // 12
    "type = \"periodic-cell\"\n"              // 13
    "[solver]\n"                              // 14
    "tolerance = 1e-6\n";                     // 15

const std::string generated =
    "dimension = 2\n"
    "thickness = 0.1\n"
    "[packing]\n"
    "generator = \"compaction\"\n"  // 4
    "count = 100\n"                 // 5
    "radii = [3e-3, 7e-3]\n"        // 6
    "seed = 1\n"                    // 7
    "pressure = 1e5\n"              // 8
    "[contact]\n"
    "law = \"frictional\"\n"
    "young = 6e8\n"
    "ratio = 0.8\n"
    "friction = 0.5\n";

struct Mistake {
  int line;  // replaced by text; 0: text is appended
  const char* text;
  int told_line;
  const char* key;       // in the message
  const char* expected;  // in the message
};

std::string with_line(const std::string& file, int line, const std::string& text) {
  if (line == 0) return file + text + "\n";
  std::istringstream in(file);
  std::string out, old;
  for (int k = 1; std::getline(in, old); ++k) out += (k == line ? text : old) + "\n";
  return out;
}

void expect_told(const std::string& file, const Mistake& mistake) {
  const std::string text = with_line(file, mistake.line, mistake.text);
  const TemporaryDirectory directory;
  for (const char* part : {"particles", "contacts", "cell"}) {
    const std::string name = std::string("rve400_") + part + ".csv";
    std::filesystem::create_symlink(data_directory + "/" + name, directory / name);
  }
  const std::string path = (directory / "drained.toml").string();
  write_text(path, text);
  char message[1024];
  grainlaw_material* made = nullptr;
  const auto status = grainlaw_material_load(path.c_str(), &made, message, sizeof message);
  expect_refused(status, GRAINLAW_BAD_MATERIAL, mistake.text);
  EXPECT_EQ(made, nullptr);
  const std::string told(message);
  const std::string place = path + ":" + std::to_string(mistake.told_line) + ": ";
  EXPECT_NE(told.find(place + mistake.key), std::string::npos) << told << "\nfor " << place;
  EXPECT_NE(told.find(mistake.expected), std::string::npos) << told;
}

TEST(bad_material, any_mistake_is_told_with_file_line_key_and_expectation) {
  const Mistake mistakes[] = {
      {1, "dimension = 3", 2, "thickness", "expected none with dimension = 3"},
      {1, "dimension = 4", 1, "dimension", "found 4, expected 2 (discs) or 3 (spheres)"},
      {1, "dimension = 2.0", 1, "dimension", "found 2.0, expected 2 (discs) or 3 (spheres)"},
      {1, "dimension = \"2\"", 1, "dimension", "expected 2 (discs) or 3 (spheres)"},
      {1, "", 1, "dimension", "found nothing, expected 2 (discs) or 3 (spheres)"},
      {1, "dimention = 2", 1, "dimension",
       "found nothing, expected 2 (discs) or 3 (spheres) (dimention in line 1?)"},
      {2, "thickness = 0", 2, "thickness", "found 0, expected a number > 0"},
      {2, "thickness = -0.1", 2, "thickness", "expected a number > 0"},
      {2, "thickness = true", 2, "thickness", "found true, expected a number > 0"},
      {2, "thickness = nan", 2, "thickness", "found nan, expected a number > 0"},
      {2, "thickness = 0.2", 2, "thickness", "found 0.2, expected 0.1 as in"},
      {2, "thicknes = 0.1", 2, "thicknes", "found an unknown key, expected one of dimension"},
      {4, "", 3, "packing.particles", "found nothing, expected either particles or generator"},
      {4, "particles = 3", 4, "packing.particles", "found 3, expected a path"},
      {4, "particles = \"\"", 4, "packing.particles", "expected a path"},
      {4, "particles = [\"a\"]", 4, "packing.particles", "expected a path"},
      {4, "particles = \"p\"\ngenerator = \"compaction\"", 5, "packing.generator", "found both"},
      {5, "contact = \"rve400_contacts.csv\"", 5, "packing.contact", "found an unknown key"},
      {5, "seed = 4", 5, "packing.seed", "found an unknown key, expected one of particles, cell"},
      {6, "", 3, "packing.cell", "found nothing, expected a path"},
      {6, "cell = {x = 1}", 6, "packing.cell", "found a table, expected a path"},
      {6, "cell = \"rve400_cell.csv\"\ndensity = 0", 7, "packing.density", "a number > 0"},
      {7, "[contacts]", 1, "contact", "found nothing, expected a table"},
      {8, "", 7, "contact.law", "found nothing, expected one of \"frictional\""},
      {8, "law = \"jkr\"", 8, "contact.law", "found 'jkr', expected one of \"frictional\""},
      {8, "law = 1", 8, "contact.law", "found 1, expected one of \"frictional\""},
      {9, "", 7, "contact.young", "found nothing, expected either young or kn"},
      {9, "young = 6e8\nkn = 1e4", 10, "contact.kn", "found both, expected either young or kn"},
      {9, "young = 0", 9, "contact.young", "expected a number > 0"},
      {9, "young = inf", 9, "contact.young", "found inf, expected a number > 0"},
      {9, "kn = -1e4", 9, "contact.kn", "expected a number > 0"},
      {9, "young = \"6e8\"", 9, "contact.young", "expected a number > 0"},
      {10, "", 7, "contact.ratio", "found nothing, expected a number >= 0"},
      {10, "ratio = -0.1", 10, "contact.ratio", "found -0.1, expected a number >= 0"},
      {11, "", 7, "contact.friction", "found nothing, expected a number >= 0"},
      {11, "friction = -1", 11, "contact.friction", "found -1, expected a number >= 0"},
      {11, "friction = [0.5]", 11, "contact.friction", "expected a number >= 0"},
      {11, "friction = 1979-05-27", 11, "contact.friction", "found 1979-05-27"},
      {11, "friction = 0.5\nrotation = 1", 12, "contact.rotation", "expected true or false"},
      {11, "friction = 0.5\nfrction = 0.5", 12, "contact.frction", "found an unknown key"},
      {13, "type = \"frame-x\"", 13, "boundary.type", "one of \"periodic-cell\", \"frame-p\""},
      {13, "method = \"servo\"", 13, "boundary.method", "a frame or mixed type"},
      {13, "method = \"penalty\"", 13, "boundary.method", "one of \"direct\", \"servo\""},
      {13, "contact_weight = 1", 13, "boundary.contact_weight", "one of \"copies\", \"one\""},
      {13, "gain = 3", 13, "boundary.gain", "found an unknown key"},
      {13, "servo.gain_force = 0", 13, "boundary.servo.gain_force", "a number > 0"},
      {13, "servo.gain_moment = -1", 13, "boundary.servo.gain_moment", "a number > 0"},
      {13, "servo.inheritance = 1.1", 13, "boundary.servo.inheritance", "from 0 to 1"},
      {13, "servo.tolerance = 0", 13, "boundary.servo.tolerance", "a number > 0"},
      {13, "servo.max_corrections = 0", 13, "boundary.servo.max_corrections", "an integer from 1"},
      {13, "servo.steps = 1", 13, "boundary.servo.steps", "found an unknown key"},
      {13, "servo.gain_force = 0.1", 13, "boundary.servo", "none with method"},
      {13, "servo = 1", 13, "boundary.servo", "found 1, expected a table"},
      {3, "[.packing]", 3, "Error while parsing key", "saw '.'"},
      {15, "tolerance = 1", 15, "solver.tolerance", "found 1, expected a number from 1e-14 to 0.1"},
      {15, "tolerance = 1e-15", 15, "solver.tolerance", "expected a number from 1e-14"},
      {15, "loose_tolerance = 1", 15, "solver.loose_tolerance", "a number from 0 to 0.1"},
      {15, "loose_tolerance = 1e-10", 15, "solver.loose_tolerance", "at least solver.tolerance"},
      {15, "force_floor = -1", 15, "solver.force_floor", "a number >= 0"},
      {15, "start = \"last\"", 15, "solver.start", "one of \"committed\", \"trial\""},
      {15, "method = \"newton\"", 15, "solver.method",
       "one of \"direct\", \"advancing\", \"published\", \"chain\""},
      {15, "contacts_lost = \"free\"", 15, "solver.contacts_lost", "\"error\", \"stress_free\""},
      {15, "contacts_lost = true", 15, "solver.contacts_lost", "one of \"error\""},
      {15, "increment_limit = 0", 15, "solver.increment_limit", "a number > 0"},
      {15, "tol = 1e-6", 15, "solver.tol", "found an unknown key, expected one of tolerance"},
      {15, "published.damping = 0", 15, "solver.published.damping", "> 0 and <= 1"},
      {15, "published.time_step_ratio = 2", 15, "solver.published.time_step_ratio", "<= 1"},
      {15, "published.energy_tolerance = -1", 15, "solver.published.energy_tolerance", ">= 0"},
      {15, "published.max_steps = 1.5", 15, "solver.published.max_steps", "an integer >= 1"},
      {15, "published.alpha = 0.7", 15, "solver.published.alpha", "found an unknown key"},
      {15, "published.damping = 0.5", 15, "solver.published", "none but with method"},
      {0, "[output]", 16, "output", "found an unknown key, expected one of dimension"},
      {0, "[[contact]]", 16, "", ""},
      {12, "[[boundary]]", 12, "boundary", "expected a table"},
      // Not TOML.
      {9, "young = ", 9, "", ""},
      {9, "young 6e8", 9, "", ""},
      {9, "young = 6e8 # Pa\nyoung = 6e8", 10, "", ""},
      {9, "young = 6 e8", 9, "", ""},
      {8, "law = \"frictional", 8, "", ""},
      {12, "[boundary", 12, "", ""},
      {12, "[contact]", 12, "", ""},
      {1, "dimension = 2\xff", 1, "", ""},
  };
  for (const Mistake& mistake : mistakes) expect_told(good, mistake);
}

TEST(bad_material, any_mistake_in_a_generator_is_told) {
  const Mistake mistakes[] = {
      {2, "", 1, "thickness", "found nothing, expected a number > 0 with a generator"},
      {4, "generator = \"rain\"", 4, "packing.generator", "expected one of \"compaction\""},
      {5, "count = 1", 5, "packing.count", "expected an integer from 2"},
      {5, "count = 100.0", 5, "packing.count", "expected an integer from 2"},
      {5, "", 3, "packing.count", "found nothing"},
      {6, "radii = 3e-3", 6, "packing.radii", "[smallest, largest]"},
      {6, "radii = [3e-3]", 6, "packing.radii", "[smallest, largest]"},
      {6, "radii = [7e-3, 3e-3]", 6, "packing.radii", "[smallest, largest]"},
      {6, "radii = [0, 3e-3]", 6, "packing.radii", "0 < smallest"},
      {6, "radii = [-6e-3, 3e-3]", 6, "packing.radii",
       "found [ -0.006, 0.003 ], expected [smallest"},
      {6, "radii = [1e-3, \"a\"]", 6, "packing.radii", "[smallest, largest]"},
      {7, "seed = -1", 7, "packing.seed", "found -1, expected an integer >= 0"},
      {8, "", 3, "packing.pressure", "found nothing, expected either pressure or void_ratio"},
      {8, "pressure = 1e5\nvoid_ratio = 0.2\nfriction = 0.1", 10, "packing.friction", "together"},
      {8, "pressure = 0", 8, "packing.pressure", "a number > 0"},
      {8, "void_ratio = -0.2", 8, "packing.void_ratio", "a number > 0"},
      {8, "pressure = 1e5\nfriction = -0.1", 9, "packing.friction", "a number >= 0"},
      {8, "pressure = 1e5\ncell = \"a\"", 9, "packing.cell", "found an unknown key"},
  };
  for (const Mistake& mistake : mistakes) expect_told(generated, mistake);
}

TEST(bad_material, the_servo_excludes_other_methods) {
  const std::string servo =
      with_line(good, 13, "type = \"frame-p\"\nmethod = \"servo\"");  // [solver] is on line 15 now
  for (const char* method : {"direct", "chain", "advancing"})
    expect_told(servo, {0, ("method = \"" + std::string(method) + "\"").c_str(), 17,
                        "solver.method", "expected \"published\""});
}

TEST(bad_material, a_file_that_cannot_be_read_is_told) {
  const TemporaryDirectory directory;
  for (const std::string& path :
       {std::string(), (directory / "none.toml").string(), directory.string()}) {
    char message[256];
    grainlaw_material* made = nullptr;
    expect_refused(grainlaw_material_load(path.c_str(), &made, message, sizeof message),
                   GRAINLAW_FILE_ERROR, path);
    EXPECT_EQ(std::string(message).rfind(path, 0), 0U) << message;
  }
}

TEST(bad_material, a_message_is_truncated_to_its_buffer) {
  const std::string expected =
      "here:1: dimension: found nothing, expected 2 (discs) or 3 (spheres)";
  for (std::size_t size = 0; size < 80; ++size) {
    std::string buffer(100, 'x');
    grainlaw_material* made = nullptr;
    expect_refused(grainlaw_material_parse("", "here", &made, buffer.data(), size),
                   GRAINLAW_BAD_MATERIAL, "empty");
    if (size > 0) {
      EXPECT_STREQ(buffer.c_str(), expected.substr(0, size - 1).c_str());
    }
    EXPECT_EQ(buffer[size], 'x');
  }
  EXPECT_EQ(grainlaw_material_parse("", nullptr, nullptr, nullptr, 10), GRAINLAW_NULL_POINTER);
}

TEST(material, a_message_is_empty_after_success) {
  char message[8] = "before";
  grainlaw_material* made = nullptr;
  ASSERT_EQ(
      grainlaw_material_parse(good.c_str(), data_directory.c_str(), &made, message, sizeof message),
      GRAINLAW_OK);
  EXPECT_STREQ(message, "");
  EXPECT_EQ(grainlaw_material_dimension(made), 2);
  grainlaw_material_destroy(made);
}

}  // namespace
}  // namespace grainlaw::test
