#include "io/vtk.hpp"

#include "../temporary_directory.hpp"
#include "base/error.hpp"
#include "io/text_file.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace grainlaw::core {
namespace {

// The numbers of a data array, as written.
std::string array_of(const std::string& text, const std::string& name) {
  const auto at = text.find("Name=\"" + name + "\"");
  if (at == std::string::npos) return "missing";
  const auto begin = text.find(">\n", at) + 2;
  return text.substr(begin, text.find("</DataArray>", begin) - begin);
}

TEST(vtk, draws_particles_as_vertices_and_contacts_as_lines) {
  const test::TemporaryDirectory directory;
  const std::string path = directory / "packing.vtp";
  const std::vector<double> position = {0, 1, 5, 6};
  const std::vector<double> radius = {0.5, 0.6};
  const std::vector<double> rotation = {0.1, -0.2};
  const std::vector<VtkContact> contacts = {{0, 1, {1, 1, 0}, 7, 2},
                                            {1, 0, {0.5, 0, 0}, 3, -1, 0.25, true}};
  write_vtk(path, position, radius, rotation, contacts);
  const std::string text = read_text(path);
  EXPECT_NE(text.find("NumberOfPoints=\"4\" NumberOfVerts=\"2\" NumberOfLines=\"2\""),
            std::string::npos);
  EXPECT_EQ(array_of(text, "points"), "0 5 0\n1 6 0\n1 6 0\n1.5 6 0\n");
  EXPECT_EQ(array_of(text, "radius"), "0.5\n0.6\n0\n0\n");
  EXPECT_EQ(array_of(text, "rotation"), "0.1\n-0.2\n0\n0\n");
  EXPECT_EQ(array_of(text, "coordination"), "2\n2\n0\n0\n");
  EXPECT_EQ(array_of(text, "normal_force"), "0\n0\n7\n3\n");
  EXPECT_EQ(array_of(text, "tangential_force"), "0\n0\n2\n-1\n");
  EXPECT_EQ(array_of(text, "moment"), "0\n0\n0\n0.25\n");
  EXPECT_EQ(array_of(text, "bonded"), "0\n0\n0\n1\n");
  EXPECT_NE(text.find("0 2\n1 3\n"), std::string::npos);
}

TEST(vtk, takes_spheres_and_no_rotation) {
  const test::TemporaryDirectory directory;
  const std::string path = directory / "spheres.vtp";
  write_vtk(path, std::vector<double>{1, 2, 3}, std::vector<double>{0.5}, {}, {});
  EXPECT_EQ(array_of(read_text(path), "points"), "1 2 3\n");
}

TEST(vtk, that_cannot_be_written_is_an_error) {
  EXPECT_THROW(write_vtk("/no/such/directory/a.vtp", {}, {}, {}, {}), Error);
}

}  // namespace
}  // namespace grainlaw::core
