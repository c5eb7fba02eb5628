// Every allocation of a load fails in turn, of good materials and of bad ones.
#include "../temporary_directory.hpp"
#include "allocator.hpp"
#include "materials.hpp"

#include <cstdio>
#include <fstream>

namespace grainlaw::core::test {
namespace {

struct Loaded {
  grainlaw_status status = GRAINLAW_INTERNAL_FAULT;
  std::string message;
};

struct LoadAttempt {
  Allocations allocations;
  Loaded loaded;
};

LoadAttempt load(const std::string& path, long k, Refuse how) {
  LoadAttempt attempt;
  grainlaw_material* material = nullptr;
  char message[512] = "";
  attempt.allocations = with_refused_allocation(k, how, [&] {
    attempt.loaded.status =
        grainlaw_material_load(path.c_str(), &material, message, sizeof message);
  });
  attempt.loaded.message = message;
  EXPECT_EQ(material != nullptr, attempt.loaded.status == GRAINLAW_OK);
  grainlaw_material_destroy(material);
  return attempt;
}

// A load that does without, as stdio does without a buffer, or that was refused what only a wrong
// file asks for, ends as ever; every other one tells, and leaves nothing behind.
long refuse_every_allocation(const std::string& path, Refuse how, grainlaw_status status) {
  const Loaded expected = load(path, 0, how).loaded;
  EXPECT_EQ(expected.status, status) << expected.message;
  long k = 0;
  while (!testing::Test::HasFailure()) {
    const auto [allocations, loaded] = load(path, ++k, how);
    if (!allocations.refused) break;
    if (loaded.status != GRAINLAW_OUT_OF_MEMORY) {
      EXPECT_EQ(loaded.status, expected.status) << "allocation " << k << ": " << loaded.message;
      EXPECT_EQ(loaded.message, expected.message) << "allocation " << k;
      continue;
    }
    EXPECT_EQ(loaded.message, grainlaw_status_text(GRAINLAW_OUT_OF_MEMORY));
    EXPECT_EQ(allocations.kept, 0) << "allocation " << k;
  }
  EXPECT_EQ(load(path, 0, how).loaded.message, expected.message);
  return k - 1;
}

// A file of a directory that also holds a small packing.
class load_without_memory : public testing::Test {
 protected:
  load_without_memory() {
    write_packing((directory_ / "small").string(), small_packing(30));
    write("header.csv", "id,x,y\n1,0,0\n");
    write("text.csv", "id,x,y,r\n1,0,zero,1\n");
  }
  ~load_without_memory() override { std::printf("allocations refused: %ld\n", refused_); }

  std::string write(const std::string& name, const std::string& text) {
    const auto path = (directory_ / name).string();
    std::ofstream(path) << text;
    return path;
  }
  void expect_told(const std::string& text, grainlaw_status status, Refuse how = Refuse::one) {
    SCOPED_TRACE(text);
    refused_ += refuse_every_allocation(write("material.toml", text), how, status);
  }

  const std::string head_ = "dimension = 2\nthickness = 0.1\n";
  const std::string contact_ =
      "[contact]\nlaw = \"frictional\"\nyoung = 6e8\nratio = 0.8\nfriction = 0.5\n";
  const std::string packing_ =
      "[packing]\nparticles = \"small_particles.csv\"\ncontacts = \"small_contacts.csv\"\n"
      "cell = \"small_cell.csv\"\n";

 private:
  TemporaryDirectory directory_;
  long refused_ = 0;
};

TEST_F(load_without_memory, of_a_packing_is_told) {
  // The number of thickness is that of the cell file.
  const std::string material = "dimension = 2\n" + packing_ + contact_;
  for (const Refuse how : {Refuse::one, Refuse::rest})
    expect_told(material + "[solver]\ntolerance = 1e-8\nstart = \"trial\"\n", GRAINLAW_OK, how);
  expect_told(material + "[boundary]\ntype = \"frame-p\"\n", GRAINLAW_OK);
}

TEST_F(load_without_memory, of_a_recipe_is_told) {
  const std::string compaction =
      "[packing]\ngenerator = \"compaction\"\ncount = 20\nradii = [1e-3, 2e-3]\nseed = 1\n"
      "pressure = 1e5\n";
  expect_told(head_ + compaction + contact_, GRAINLAW_OK);
  expect_told(head_ + compaction + contact_ + "[boundary]\ntype = \"frame-t\"\n", GRAINLAW_OK,
              Refuse::rest);
  expect_told(head_ +
                  "[packing]\ngenerator = \"hexagonal\"\ncolumns = 4\nrows = 4\nradius = 1e-3\n"
                  "pressure = 1e5\n" +
                  contact_,
              GRAINLAW_OK);
}

TEST_F(load_without_memory, of_a_wrong_material_is_told_or_what_is_wrong_is) {
  const auto both = [&](const std::string& text, grainlaw_status status) {
    for (const Refuse how : {Refuse::one, Refuse::rest}) expect_told(text, status, how);
  };
  both("dimension = \n", GRAINLAW_BAD_MATERIAL);
  both("dimension = 2\nthickness = 0.1\nthicknes = 0.1\n" + packing_ + contact_,
       GRAINLAW_BAD_MATERIAL);
  both("dimension = 2\n" + packing_ + contact_ + "[solver]\ntolerance = [1, 2.5, \"three\"]\n",
       GRAINLAW_BAD_MATERIAL);
  both("dimension = 2\n[packing]\nparticles = \"none.csv\"\ncell = \"small_cell.csv\"\n" + contact_,
       GRAINLAW_FILE_ERROR);
  for (const char* name : {"header.csv", "text.csv", "small_cell.csv"})
    both("dimension = 2\n[packing]\nparticles = \"" + std::string(name) +
             "\"\ncell = \"small_cell.csv\"\n" + contact_,
         GRAINLAW_BAD_PACKING);
}

}  // namespace
}  // namespace grainlaw::core::test
