// Boundary conditions and frames with mistakes: refused with what, where and what was expected.
#include "support.hpp"

namespace grainlaw::test {
namespace {

const std::string header =
    "dimension = 2\n"                                     // 1
    "[packing]\n"                                         // 2
    "particles = \"particles.csv\"\n"                     // 3
    "cell = \"cell.csv\"\n"                               // 4
    "[contact]\n"                                         // 5
    "law = \"frictional\"\n"                              // 6
    "kn = 1e5\n"                                          // 7
    "ratio = 0.8\n"                                       // 8
    "friction = 0.5\n"                                    // 9
    "[boundary]\n";                                       // 10
const std::string mixed = header + "type = \"mixed\"\n";  // 11

const std::string columns = "id,x,y,r,role,partner,frame_order\n";
const std::string inner = "8,1,1,0.505,inner,-1,-1\n";
const std::string corners =
    "0,0,0,0.505,corner,-1,0\n2,2,0,0.505,corner,-1,2\n4,2,2,0.505,corner,-1,4\n"
    "6,0,2,0.505,corner,-1,6\n";
const std::string edges =
    "1,1,0,0.505,edge,-1,1\n3,2,1,0.505,edge,-1,3\n5,1,2,0.505,edge,-1,5\n7,0,1,0.505,edge,-1,7\n";
const std::string copies =
    "1,1,0,0.505,edge,5,1\n3,2,1,0.505,edge,7,3\n5,1,2,0.505,edge,1,5\n7,0,1,0.505,edge,3,7\n";
const std::string chain = columns + inner + corners + edges;
const std::string frame = columns + inner + corners + copies;

std::string sides(const std::string& left, const std::string& right, const std::string& bottom,
                  const std::string& top) {
  return mixed + "left = {" + left + "}\nright = {" + right + "}\nbottom = {" + bottom +
         "}\ntop = {" + top + "}\n";  // 12 to 15
}
const std::string p = "x = \"P\"";
const std::string d = "x = \"D\"";
const std::string t = "x = \"T\"";

void expect_told(const std::string& text, const std::string& particles, grainlaw_status expected,
                 const std::string& told) {
  const TemporaryDirectory directory;
  write_text(directory / "particles.csv", particles);
  write_text(directory / "cell.csv", "H00,H01,H10,H11,thickness\n2,0,0,2,0.1\n");
  write_text(directory / "material.toml", text);
  char message[1024];
  grainlaw_material* made = nullptr;
  const auto path = (directory / "material.toml").string();
  expect_refused(grainlaw_material_load(path.c_str(), &made, message, sizeof message), expected,
                 told);
  EXPECT_EQ(made, nullptr);
  EXPECT_NE(std::string(message).find(told), std::string::npos) << message << "\nfor " << told;
}

TEST(bad_boundary, good_ones_are_taken) {
  for (const auto& [text, particles] : {std::pair(header + "type = \"frame-d\"\n", chain),
                                        {header + "type = \"frame-d\"\n", frame},
                                        {header + "type = \"frame-p\"\n", frame},
                                        {sides(p, p, d, d), frame},
                                        {sides(d, d, d, d), chain}}) {
    const TemporaryDirectory directory;
    write_text(directory / "particles.csv", particles);
    write_text(directory / "cell.csv", "H00,H01,H10,H11,thickness\n2,0,0,2,0.1\n");
    char message[1024];
    grainlaw_material* made = nullptr;
    EXPECT_EQ(grainlaw_material_parse(text.c_str(), directory.string().c_str(), &made, message,
                                      sizeof message),
              GRAINLAW_OK)
        << message;
    grainlaw_material_destroy(made);
  }
}

TEST(bad_boundary, keys_are_told_with_file_and_line) {
  const auto wrong = [](const std::string& text, const std::string& told) {
    expect_told(text, frame, GRAINLAW_BAD_MATERIAL, told);
  };
  wrong(header + "type = \"frame-q\"\n",
        ":11: boundary.type: found 'frame-q', expected one of \"periodic-cell\", \"frame-p\", "
        "\"frame-d\", \"frame-t\", \"mixed\"");
  wrong(header + "type = \"frame-d\"\nleft = {x = \"P\"}\n",
        ":12: boundary.left: found an unknown");
  wrong(mixed, ":10: boundary.left: found nothing, expected a table");
  wrong(sides("", p, d, d), ":12: boundary.left.x: found nothing, expected one of \"D\"");
  wrong(sides("x = \"Q\"", p, d, d), ":12: boundary.left.x: found 'Q'");
  wrong(sides(p, p, d, d + ", z = 1"), ":15: boundary.top.z: found an unknown key");
  wrong(sides(p, d, d, d),
        ":12: boundary.left: found another rule than on the opposite side, "
        "expected the same on right");
  wrong(sides(d, d, p, t), ":14: boundary.bottom: found another rule");
  wrong(sides("x = \"P\", y = \"T\"", "x = \"P\", y = \"T\"", d, d),
        ":12: boundary.left.y: found \"T\" beside \"P\"");
  wrong(sides(p + ", rotation = \"free\"", p, d, d), ":12: boundary.left.rotation: found \"free\"");
  wrong(sides(d, d, d, t + ", rotation = \"periodic\""),
        ":15: boundary.top.rotation: found \"periodic\" on a \"T\" side");
  wrong(sides(d, d, d, d + ", rotation = \"none\""), ":15: boundary.top.rotation: found 'none'");
  wrong(sides(p + ", row = \"rigid\"", p, d, d), ":12: boundary.left.row: found \"rigid\"");
  wrong(sides(d, d, d, d + ", row = \"soft\""), ":15: boundary.top.row: found 'soft'");
  wrong(sides(d, d, d, d) + "stress = {P33 = 1}\n", ":16: boundary.stress.P33: found an unknown");
  wrong(sides(d, d, d, d) + "stress = {P22 = nan}\n", ":16: boundary.stress.P22: found nan");
  wrong(sides(d, d, d, d) + "stress = 3\n", ":16: boundary.stress: found 3, expected a table");
  wrong(sides(d, d, d, d) + "stress = {P11 = -1, P12 = 0, P21 = 0, P22 = -1}\n",
        ":16: boundary.stress: found all four components, expected at most three");
  wrong(header + "type = \"frame-t\"\nservo.gain_deformation = 2\n",
        ":12: boundary.servo.gain_deformation: found 2");
  wrong(
      header + "inner_rotation = \"fixed\"\n",
      ":11: boundary.inner_rotation: found \"fixed\" in a periodic cell, expected a frame or mixed "
      "type with it, or contact.rotation = false");
  std::string locked = header + "type = \"frame-d\"\ninner_rotation = \"fixed\"\n";
  locked.insert(locked.find("[boundary]"), "rotation = false\n");
  wrong(locked, ":13: boundary.inner_rotation: found \"fixed\" where no particle rotates");
}

TEST(bad_boundary, frames_are_told) {
  const auto wrong = [](const std::string& type, const std::string& particles,
                        const std::string& told) {
    expect_told(header + "type = \"" + type + "\"\n", particles, GRAINLAW_BAD_PACKING, told);
  };
  wrong("frame-d", columns + inner + corners.substr(corners.find('\n') + 1) + edges,
        "particles.csv: found 3 particles of role 'corner', expected 4");
  wrong("frame-d", columns + inner + corners + edges.substr(edges.find('\n') + 1),
        "particles.csv: frame_order has no 1, expected 0 to 6 without a gap");
  wrong("frame-d", columns + inner + corners, "particles.csv: frame_order has no 1");
  wrong("frame-d",
        columns + inner +
            "0,0,0,0.5,corner,-1,0\n2,4,0,0.5,corner,-1,1\n4,4,2,0.5,corner,-1,2\n"
            "6,0,2,0.5,corner,-1,3\n",
        "particles.csv: frame: the boundary has a hole of 3 m after frame_order 0");
  wrong("frame-d",
        columns + inner +
            "0,0,0,0.505,corner,-1,0\n6,2,0,0.505,corner,-1,6\n"
            "4,2,2,0.505,corner,-1,4\n2,0,2,0.505,corner,-1,2\n"
            "1,0,1,0.505,edge,-1,1\n3,1,2,0.505,edge,-1,3\n5,2,1,0.505,edge,-1,5\n"
            "7,1,0,0.505,edge,-1,7\n",
        "anticlockwise");
  wrong("frame-p", chain, "are not copies of each other");
  expect_told(sides(p, p, d, d), chain, GRAINLAW_BAD_PACKING,
              "boundary: left and right are \"P\" or \"periodic\", but are not copies");
  // Three particles under uniform stress, the corners being held by the other sides.
  expect_told(sides(d, d, d, t), frame, GRAINLAW_BAD_PACKING,
              "boundary: \"T\" holds 1 particles in x, expected at least 4");
}

TEST(bad_boundary, stress_that_no_state_carries_is_told) {
  expect_told(sides(p, p, d, d) + "stress = {P22 = 1e9}\n", frame, GRAINLAW_NOT_CONVERGED,
              "boundary.stress: no state of the packing carries P22 = 1e+09 Pa");
}

TEST(bad_boundary, stress_on_a_packing_that_may_be_free_of_it_is_told) {
  const std::string free = "[solver]\ncontacts_lost = \"stress_free\"\n";
  const std::string expected = "expected \"error\": without contacts nothing carries";
  const auto told = [&](const std::string& text, int line) {
    expect_told(text + free, frame, GRAINLAW_BAD_MATERIAL,
                "material.toml:" + std::to_string(line) + ": solver.contacts_lost");
    expect_told(text + free, frame, GRAINLAW_BAD_MATERIAL, expected);
  };
  told(header + "type = \"frame-t\"\n", 13);
  told(sides(d, d, t, d), 17);
  told(sides(p, p, d, d) + "stress = {P22 = -1e3}\n", 18);
}

TEST(bad_boundary, force_floor_under_a_stress_is_told) {
  const std::string floor = "[solver]\nforce_floor = 1e-3\n";
  for (const auto& text : {header + "type = \"frame-t\"\n", sides(d, d, t, d),
                           sides(d, d, d, d) + "stress = {P22 = -1e5}\n"}) {
    for (const char* told : {"solver.force_floor: found 0.001 with a boundary under a stress",
                             "expected 0: below a floor nothing carries"}) {
      expect_told(text + floor, frame, GRAINLAW_BAD_MATERIAL, told);
    }
  }
}

TEST(bad_boundary, failed_increment_keeps_the_state) {
  const TemporaryDirectory directory;
  write_text(directory / "particles.csv", frame);
  write_text(directory / "cell.csv", "H00,H01,H10,H11,thickness\n2,0,0,2,0.1\n");
  for (const std::string type : {"frame-d", "frame-p"}) {
    const Material made =
        Material::parse(header + "type = \"" + type + "\"\n", directory.string().c_str());
    State state(made);
    const Tensor before = stress(state, identity);
    Tensor P{1, 2, 3, 4};
    const Tensor stretched{1.1, 0, 0, 1.1};
    expect_refused(grainlaw_evaluate(state.get(), stretched.data(), 0, P.data(), nullptr, nullptr),
                   GRAINLAW_CONTACTS_LOST, type);
    EXPECT_EQ(P, (Tensor{1, 2, 3, 4}));
    EXPECT_TRUE(same_bits(stress(state, identity), before));
  }
}

}  // namespace
}  // namespace grainlaw::test
