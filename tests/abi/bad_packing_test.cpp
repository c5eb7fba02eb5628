// Packing files with mistakes: refused with the file, and the line where there is one.
#include "support.hpp"

#include <cstdlib>

namespace grainlaw::test {
namespace {

// Two discs that touch in a cell, in a row that closes on itself, and the row above.
const std::string particles =
    "id,x,y,r\n0,0,0,0.501\n1,1,0,0.501\n2,0.5,0.866,0.501\n3,1.5,0.866,0.501\n";
const std::string contacts = "i,j,shift_x,shift_y,fn,ftx_on_j,fty_on_j\n0,1,0,0,200,0,0\n";
const std::string cell = "H00,H01,H10,H11,thickness\n2,0,0,1.732,0.1\n";
const std::string file =
    "dimension = 2\n[packing]\nparticles = \"particles.csv\"\ncontacts = \"contacts.csv\"\n"
    "cell = \"cell.csv\"\n[contact]\nlaw = \"frictional\"\nkn = 1e5\nratio = 0.8\nfriction = 0.5\n";

struct Mistake {
  const char* name;  // of the wrong file
  std::string text;
  const char* told;  // after the directory
};

void expect_told(const Mistake& mistake) {
  const TemporaryDirectory directory;
  write_text(directory / "particles.csv", particles);
  write_text(directory / "contacts.csv", contacts);
  write_text(directory / "cell.csv", cell);
  write_text(directory / mistake.name, mistake.text);
  char message[1024];
  grainlaw_material* made = nullptr;
  expect_refused(grainlaw_material_parse(file.c_str(), directory.string().c_str(), &made, message,
                                         sizeof message),
                 GRAINLAW_BAD_PACKING, mistake.told);
  EXPECT_EQ(made, nullptr);
  const std::string place = (directory / mistake.told).string();
  EXPECT_EQ(std::string(message).rfind(place, 0), 0U) << message << "\nfor " << place;
}

TEST(bad_packing, any_mistake_is_told_with_file_and_line) {
  const std::string header = "id,x,y,r\n";
  const std::string contact_header = "i,j,shift_x,shift_y,fn,ftx_on_j,fty_on_j\n";
  const std::string cell_header = "H00,H01,H10,H11,thickness\n";
  const Mistake mistakes[] = {
      {"particles.csv", "", "particles.csv:"},
      {"particles.csv", header, "particles.csv:"},
      {"particles.csv", "id,x,y\n0,0,0\n", "particles.csv:1"},
      {"particles.csv", "id,x,r\n0,0,1\n", "particles.csv:1"},
      {"particles.csv", "x,y,r\n0,0,1\n", "particles.csv:1"},
      {"particles.csv", "id,x,y,r,r\n0,0,0,1,1\n", "particles.csv"},
      {"particles.csv", header + "0,0,0,-0.5\n", "particles.csv:2"},
      {"particles.csv", header + "0,0,0,0\n", "particles.csv:2"},
      {"particles.csv", header + "0,0,0,nan\n", "particles.csv:2"},
      {"particles.csv", header + "0,inf,0,0.5\n", "particles.csv:2"},
      {"particles.csv", header + "0,0,,0.5\n", "particles.csv:2"},
      {"particles.csv", header + "0,0,0,0.5\n0,1,0,0.5\n", "particles.csv:3"},
      {"particles.csv", header + "0,0,0,0.5\na,1,0,0.5\n", "particles.csv:3"},
      {"particles.csv", header + "0,0,0,0.5\n1.5,1,0,0.5\n", "particles.csv:3"},
      {"particles.csv", header + "0,0,0\n", "particles.csv"},
      {"particles.csv", header + "0,0,0,0.5,7\n", "particles.csv"},
      {"particles.csv", header + "0,0,0,0.5m\n", "particles.csv:2"},
      {"contacts.csv", "i,j,shift_x,shift_y,fn,ftx_on_j\n", "contacts.csv:1"},
      {"contacts.csv", contact_header + "0,9,0,0,1,0,0\n", "contacts.csv:2"},
      {"contacts.csv", contact_header + "-1,1,0,0,1,0,0\n", "contacts.csv:2"},
      {"contacts.csv", contact_header + "0,0,0,0,1,0,0\n", "contacts.csv:2"},
      {"contacts.csv", contact_header + "0,1,0,0,nan,0,0\n", "contacts.csv:2"},
      {"contacts.csv", contact_header + "0,1,7,0,1,0,0\n", "contacts.csv:2"},
      {"contacts.csv", contact_header + "0,1,0.5,0,1,0,0\n", "contacts.csv:2"},
      {"contacts.csv", contact_header + "0,1,99999,0,1,0,0\n", "contacts.csv:2"},
      {"contacts.csv", contacts + "1,0,0,0,200,0,0\n", "contacts.csv:3"},
      {"cell.csv", cell_header, "cell.csv:"},
      {"cell.csv", "H00,H01,H10,H11\n2,0,0,1.732\n", "cell.csv:1"},
      {"cell.csv", cell_header + "2,0,0,0,0.1\n", "cell.csv:2"},
      {"cell.csv", cell_header + "-2,0,0,1.732,0.1\n", "cell.csv:2"},
      {"cell.csv", cell_header + "2,0,0,1.732,0\n", "cell.csv:2"},
      {"cell.csv", cell_header + "2,0,0,x,0.1\n", "cell.csv:2"},
      {"cell.csv", cell + "2,0,0,1.732,0.1\n", "cell.csv:3"},
  };
  for (const Mistake& mistake : mistakes) expect_told(mistake);
}

TEST(bad_packing, a_missing_file_is_told) {
  for (const char* missing : {"particles.csv", "contacts.csv", "cell.csv"}) {
    const TemporaryDirectory directory;
    write_text(directory / "particles.csv", particles);
    write_text(directory / "contacts.csv", contacts);
    write_text(directory / "cell.csv", cell);
    std::filesystem::remove(directory / missing);
    char message[1024];
    grainlaw_material* made = nullptr;
    expect_refused(grainlaw_material_parse(file.c_str(), directory.string().c_str(), &made, message,
                                           sizeof message),
                   GRAINLAW_FILE_ERROR, missing);
    EXPECT_NE(std::string(message).find(missing), std::string::npos) << message;
  }
}

// The message for these files in the cell above.
std::string message_for(const std::string& particle_text, const std::string& contact_text,
                        grainlaw_status status) {
  const TemporaryDirectory directory;
  write_text(directory / "particles.csv", particle_text);
  write_text(directory / "contacts.csv", contact_text);
  write_text(directory / "cell.csv", cell);
  char message[1024];
  grainlaw_material* made = nullptr;
  expect_refused(grainlaw_material_parse(file.c_str(), directory.string().c_str(), &made, message,
                                         sizeof message),
                 status, contact_text);
  return message;
}

TEST(bad_packing, without_contacts_carries_no_stress) {
  EXPECT_NE(message_for("id,x,y,r\n0,0,0,0.1\n1,1,0,0.1\n",
                        "i,j,shift_x,shift_y,fn,ftx_on_j,fty_on_j\n", GRAINLAW_CONTACTS_LOST),
            "");
}

TEST(bad_packing, of_another_stiffness_than_its_forces_is_told) {
  std::string text = read_text(material_path);
  text.replace(text.find("young = 6e8"), 11, "young = 5e8");
  char message[1024];
  grainlaw_material* made = nullptr;
  expect_refused(
      grainlaw_material_parse(text.c_str(), data_directory.c_str(), &made, message, sizeof message),
      GRAINLAW_BAD_PACKING, "another young");
  EXPECT_NE(std::string(message).find("forces"), std::string::npos) << message;
}

TEST(bad_packing, of_forces_that_no_friction_holds_is_told) {
  const std::string message =
      message_for(particles, "i,j,shift_x,shift_y,fn,ftx_on_j,fty_on_j\n0,1,0,0,200,0,3e4\n",
                  GRAINLAW_BAD_PACKING);
  EXPECT_NE(message.find("add up to 30000 N, normal ones to 200 N"), std::string::npos) << message;
}

}  // namespace
}  // namespace grainlaw::test
