#include "material/packing_file.hpp"

#include "../data.hpp"
#include "../temporary_directory.hpp"
#include "base/error.hpp"
#include "frame/frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>

namespace grainlaw::core {
namespace {

const std::string data = grainlaw::test::data_file("rve400_");

const char* const good_particles = "id,x,y,r\n7,0.1,0.1,0.1\n-3,0.29,0.1,0.1\n";
const char* const good_contacts =
    "i,j,shift_x,shift_y,fn,ftx_on_j,fty_on_j\n7,-3,0,0,10,0,2\n-3,7,1,0,4,0,1\n";
const char* const good_cell = "H00,H01,H10,H11,thickness\n0.39,0,0,0.3,0.1\n";

class packing_file : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return directory_ / name; }

  Packing read(const std::string& particles, const std::string& contacts, const std::string& cell) {
    std::ofstream(path("p.csv"), std::ios::binary) << particles;
    std::ofstream(path("c.csv"), std::ios::binary) << contacts;
    std::ofstream(path("h.csv"), std::ios::binary) << cell;
    return read_packing({path("p.csv"), path("c.csv"), path("h.csv")});
  }

  // Reading fails with BAD_PACKING and a message that holds `part`.
  void expect_refused(const std::string& part, const std::string& particles,
                      const std::string& contacts, const std::string& cell) {
    try {
      read(particles, contacts, cell);
      ADD_FAILURE() << "accepted; expected " << part;
    } catch (const Error& error) {
      EXPECT_EQ(error.status, GRAINLAW_BAD_PACKING);
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
          << error.what() << "\nexpected " << part;
    }
  }
  void expect_particles_refused(const std::string& part, const std::string& particles) {
    expect_refused(part, particles, good_contacts, good_cell);
  }
  void expect_contacts_refused(const std::string& part, const std::string& lines) {
    expect_refused(part, good_particles, "i,j,shift_x,shift_y,fn,ftx_on_j,fty_on_j\n" + lines,
                   good_cell);
  }
  void expect_cell_refused(const std::string& part, const std::string& cell) {
    expect_refused(part, good_particles, good_contacts, cell);
  }

  test::TemporaryDirectory directory_;
};

void expect_equal(const Packing& a, const Packing& b) {
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.cell, b.cell);
  EXPECT_EQ(a.thickness, b.thickness);
  EXPECT_EQ(a.density, b.density);
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t c = 0; c < a.contacts.size(); ++c) {
    EXPECT_EQ(a.contacts[c].i, b.contacts[c].i);
    EXPECT_EQ(a.contacts[c].j, b.contacts[c].j);
    EXPECT_EQ(a.contacts[c].shift, b.contacts[c].shift);
    EXPECT_EQ(a.contacts[c].normal_force, b.contacts[c].normal_force);
    EXPECT_EQ(a.contacts[c].tangential_force, b.contacts[c].tangential_force);
  }
}

TEST_F(packing_file, fields_in_quotes_are_read_and_other_columns_may_hold_commas) {
  const Packing packing = read(
      "\"id\",material,\"x\",y,r\n\"7\",\"sand, \"\"fine\"\"\",\"0.1\",0.1,0.1\n"
      "-3,gravel,0.3,0.1,0.1\n",
      good_contacts, good_cell);
  EXPECT_EQ(packing.size(), 2U);
  EXPECT_EQ(packing.position, (std::vector<double>{0.1, 0.3, 0.1, 0.1}));
}

TEST_F(packing_file, of_yade_is_read_in_equilibrium) {
  const Packing packing =
      read_packing({data + "particles.csv", data + "contacts.csv", data + "cell.csv"});
  ASSERT_EQ(packing.size(), 400U);
  ASSERT_EQ(packing.contacts.size(), 831U);
  EXPECT_EQ(packing.density, 2650);
  // Each contact touches, and forces and branches add up to the stress that YADE reports.
  const std::size_t n = packing.size();
  const auto& h = packing.cell;
  double stress[4] = {};
  for (const InitialContact& c : packing.contacts) {
    const auto i = static_cast<std::size_t>(c.i);
    const auto j = static_cast<std::size_t>(c.j);
    const double lx = packing.position[j] - packing.position[i] + h[0] * c.shift[0];
    const double ly = packing.position[n + j] - packing.position[n + i] + h[3] * c.shift[1];
    const double d = std::hypot(lx, ly);
    EXPECT_LT(d, packing.radius[i] + packing.radius[j]);
    const double fx = c.normal_force * lx / d + c.tangential_force[0];
    const double fy = c.normal_force * ly / d + c.tangential_force[1];
    const double volume = h[0] * h[3] * packing.thickness;
    stress[0] -= fx * lx / volume;
    stress[1] -= fx * ly / volume;
    stress[2] -= fy * lx / volume;
    stress[3] -= fy * ly / volume;
  }
  EXPECT_NEAR(stress[0], -100000.01322892752, 1e-3);
  EXPECT_NEAR(stress[1], 616.82547832801629, 1e-1);
  EXPECT_NEAR(stress[3], -100000.01693568606, 1e-3);
}

TEST_F(packing_file, read_back_has_the_same_bits) {
  const Packing packing =
      read_packing({data + "particles.csv", data + "contacts.csv", data + "cell.csv"});
  write_packing(path("a"), packing);
  expect_equal(packing,
               read_packing({path("a_particles.csv"), path("a_contacts.csv"), path("a_cell.csv")}));
}

TEST_F(packing_file, of_a_frame_read_back_is_the_same_frame) {
  const Packing packing =
      cut_frame(read_packing({data + "particles.csv", data + "contacts.csv", data + "cell.csv"}));
  write_packing(path("a"), packing);
  const Packing back =
      read_packing({path("a_particles.csv"), path("a_contacts.csv"), path("a_cell.csv")});
  expect_equal(packing, back);
  ASSERT_TRUE(back.frame);
  EXPECT_EQ(back.frame->boundary, packing.frame->boundary);
  EXPECT_EQ(back.frame->corner, packing.frame->corner);
  EXPECT_EQ(back.frame->partner, packing.frame->partner);
  EXPECT_EQ(back.frame->area, packing.frame->area);
  EXPECT_EQ(back.frame->source, packing.frame->source);
  EXPECT_EQ(back.frame->offset, packing.frame->offset);
  EXPECT_EQ(back.frame->extent, packing.frame->extent);
}

TEST_F(packing_file, may_have_its_columns_in_any_order_and_odd_line_ends) {
  const Packing packing = read("note, r ,y,x,id\r\na,0.1,0.1,0.1,7\r\n\r\nb, 0.1 ,0.1,0.29,-3",
                               good_contacts, good_cell);
  expect_equal(packing, read(good_particles, good_contacts, good_cell));
  EXPECT_EQ(packing.density, 2650);
}

TEST_F(packing_file, contacts_come_out_ordered_with_forces_on_the_later_particle) {
  const Packing packing = read(good_particles, good_contacts, good_cell);
  ASSERT_EQ(packing.contacts.size(), 2U);
  EXPECT_EQ(packing.contacts[0].shift, (std::array{-1, 0, 0}));
  EXPECT_EQ(packing.contacts[0].i, 0);
  EXPECT_EQ(packing.contacts[0].tangential_force[1], -1);
  EXPECT_EQ(packing.contacts[1].shift, (std::array{0, 0, 0}));
  EXPECT_EQ(packing.contacts[1].normal_force, 10);
}

TEST_F(packing_file, without_contacts_has_none) {
  read(good_particles, good_contacts, good_cell);
  EXPECT_TRUE(read_packing({path("p.csv"), "", path("h.csv")}).contacts.empty());
}

TEST_F(packing_file, keeps_the_bits_of_extreme_numbers) {
  Packing packing = read(good_particles, good_contacts, good_cell);
  packing.position = {-0.0, 0.1 + 1e-16, 1.0 / 3, std::numeric_limits<double>::min()};
  packing.contacts.clear();
  write_packing(path("a"), packing);
  const Packing back = read_packing({path("a_particles.csv"), "", path("a_cell.csv")});
  EXPECT_EQ(back.position, packing.position);
  EXPECT_TRUE(std::signbit(back.position[0]));
}

TEST_F(packing_file, that_is_missing_or_not_writable_is_a_file_error) {
  try {
    read_packing({path("none.csv"), "", data + "cell.csv"});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.status, GRAINLAW_FILE_ERROR);
    EXPECT_NE(std::string(error.what()).find("none.csv"), std::string::npos);
  }
  EXPECT_THROW(read_packing({directory_.string(), "", data + "cell.csv"}), Error);
  EXPECT_THROW(write_packing(path("no/such/directory"), Packing{}), Error);
}

TEST_F(packing_file, with_wrong_particles_is_refused) {
  expect_particles_refused("empty", "");
  expect_particles_refused("no particle", "id,x,y,r\n");
  expect_particles_refused("p.csv:1: the header has no column 'y'; found 'id,x,r'",
                           "id,x,r\n1,2,3\n");
  expect_particles_refused("p.csv:2: column 'x': found 'abc'", "id,x,y,r\n7,abc,0,1\n");
  expect_particles_refused("found ''", "id,x,y,r\n7,,0,1\n");
  expect_particles_refused("found '1 2'", "id,x,y,r\n7,1 2,0,1\n");
  expect_particles_refused("found 'nan'", "id,x,y,r\n7,nan,0,1\n");
  expect_particles_refused("found 'inf'", "id,x,y,r\n7,0,inf,1\n");
  expect_particles_refused("found '1e999'", "id,x,y,r\n7,0,1e999,1\n");
  expect_particles_refused("expected a number > 0", "id,x,y,r\n7,0,0,0\n");
  expect_particles_refused("expected a number > 0", "id,x,y,r\n7,0,0,-1\n");
  expect_particles_refused("expected an integer", "id,x,y,r\n7.5,0,0,1\n");
  expect_particles_refused("p.csv:3: column 'id': found '7'", "id,x,y,r\n7,0,0,1\n7,3,0,1\n");
  expect_particles_refused("p.csv:2: the centre is", "id,x,y,r\n7,1e20,0,1\n");
  expect_particles_refused("cells from the first", "id,x,y,r\n7,0,0,1\n8,0,1e5,1\n");
  expect_particles_refused("p.csv:2: fewer fields", "id,x,y,r\n7,0,0\n");
  expect_particles_refused("p.csv:2: more fields", "id,x,y,r\n7,0,0,1,5\n");
  expect_particles_refused("stands twice", "id,x,y,r,x\n7,0,0,1,5\n");
  expect_particles_refused("not a text file", std::string("id,x,y,r\n7,0,0,1\0junk\n", 22));
}

TEST_F(packing_file, with_wrong_contacts_is_refused) {
  expect_contacts_refused("c.csv:2: column 'j': found '8', expected the id", "7,8,0,0,1,0,0\n");
  expect_contacts_refused("with itself", "7,7,0,0,1,0,0\n");
  expect_contacts_refused("do not touch", "7,-3,0,1,1,0,0\n");
  expect_contacts_refused("contact of line 2 again", "7,-3,0,0,1,0,0\n7,-3,0,0,1,0,0\n");
  expect_contacts_refused("contact of line 2 again", "7,-3,0,0,1,0,0\n-3,7,0,0,1,0,0\n");
  expect_contacts_refused("32767", "7,-3,40000,0,1,0,0\n");
  expect_contacts_refused("32767", "7,-3,0,-9223372036854775808,1,0,0\n");
  expect_contacts_refused("found '0.5', expected an integer", "7,-3,0.5,0,1,0,0\n");
  expect_contacts_refused("expected a finite number", "7,-3,0,0,-nan,0,0\n");
  expect_refused("no column 'fn'", good_particles, "i,j,shift_x,shift_y\n7,-3,0,0\n", good_cell);
}

TEST_F(packing_file, with_lengths_in_different_units_is_refused) {
  // Radii, then places, then the cell in mm.
  expect_particles_refused("p.csv: particle 7 of radius 100 m is larger than the cell, 0.3 m high",
                           "id,x,y,r\n7,0.1,0.1,100\n-3,0.29,0.1,100\n");
  expect_particles_refused("particles 7 and -3 of radii 0.1 and 0.1 m are 0.05 m apart",
                           "id,x,y,r\n7,0.1,0.1,0.1\n-3,390.15,0.1,0.1\n");
  expect_cell_refused("p.csv: particle 7 of radius 0.1 m is larger than the cell",
                      "H00,H01,H10,H11,thickness\n0.00039,0,0,0.0003,0.1\n");
}

TEST_F(packing_file, with_a_wrong_cell_is_refused) {
  const std::string header = "H00,H01,H10,H11,thickness\n";
  expect_cell_refused("det H > 0", header + "1,2,1,2,0.1\n");
  expect_cell_refused("det H > 0", header + "1,0,0,-1,0.1\n");
  expect_cell_refused("'thickness': found '0'", header + "0.39,0,0,0.3,0\n");
  expect_cell_refused("expected one line", header);
  expect_cell_refused("expected one line", header + "0.39,0,0,0.3,1\n0.39,0,0,0.3,1\n");
  expect_cell_refused("no column 'thickness'", "H00,H01,H10,H11\n1,0,0,1\n");
}

TEST_F(packing_file, with_a_wrong_frame_is_refused) {
  // A frame of four corners around one disc.
  const std::string header = "id,x,y,r,role,partner,frame_order\n0,0.5,0.5,0.4,inner,-1,-1\n";
  const std::string cell = "H00,H01,H10,H11,thickness\n1,0,0,1,1\n";
  const std::string contacts = "i,j,shift_x,shift_y,fn,ftx_on_j,fty_on_j\n";
  const std::string rest = "2,1,0,0.5,corner,-1,1\n3,1,1,0.5,corner,-1,2\n4,0,1,0.5,corner,-1,3\n";
  const std::string first = "1,0,0,0.5,corner,-1,0\n";
  EXPECT_EQ(read(header + first + rest, contacts, cell).frame->boundary.size(), 4U);
  expect_refused("expected 4", header + rest, contacts, cell);
  expect_refused("shifted by lattice vector", header + "1,0.1,0,0.5,corner,-1,0\n" + rest, contacts,
                 cell);
  expect_refused("differ in radius", header + "1,0,0,0.4,corner,-1,0\n" + rest, contacts, cell);
  expect_refused("expected inner, edge or corner", header + "1,0,0,0.5,side,-1,0\n" + rest,
                 contacts, cell);
  expect_refused("a place that no other particle has", header + "1,0,0,0.5,corner,-1,1\n" + rest,
                 contacts, cell);
  expect_refused("expected 0, since a frame", header + first + rest, contacts + "1,2,1,0,0,0,0\n",
                 cell);
  expect_refused("no column 'partner'", "id,x,y,r,role\n0,0.5,0.5,0.4,inner\n", contacts, cell);
  const std::string edges = "5,0.5,0,0.5,edge,6,4\n6,0.5,1,0.5,edge,5,5\n";
  expect_refused("opposite sides differ", header + first + rest + edges, contacts, cell);
}

}  // namespace
}  // namespace grainlaw::core
