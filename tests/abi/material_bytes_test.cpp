// Materials as bytes: the same answers without the files; damage and other bytes are told.
#include "seal.hpp"
#include "support.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <random>

namespace grainlaw::test {
namespace {

using Bytes = std::vector<std::byte>;

struct Law {
  const char* name;
  const char* file;
  const char* more;
  const char* of_bonds = "";  // more keys of `bond`
};

std::string text_of(const Law& law) {
  std::string text = read_text(data_directory + "/" + law.file) + law.more;
  const std::string bond = "bond = {";
  if (*law.of_bonds != 0) text.insert(text.find(bond) + bond.size(), law.of_bonds);
  return text;
}

constexpr const char* springs = " normal_stiffness = 4e7, tangential_stiffness = 1.5e7,";

class saved_material : public testing::TestWithParam<Law> {};

TEST_P(saved_material, gives_the_bits_of_the_one_that_was_read) {
  const Material read = Material::parse(text_of(GetParam()), data_directory);
  const Bytes bytes = read.save();
  const Material made = Material::load_saved(bytes);
  EXPECT_EQ(made.fingerprint(), read.fingerprint());
  EXPECT_TRUE(same_bits(made.save(), bytes));
  const auto square = static_cast<std::size_t>(read.dimension() * read.dimension());
  std::vector<double> F(square), P(square), A(square * square), other_P(P), other_A(A);
  for (std::size_t k = 0; k < square; ++k) {
    const auto d = static_cast<std::size_t>(read.dimension());
    F[k] = k % (d + 1) == 0 ? 1 - 3e-4 * static_cast<double>(k) : 1e-4 * static_cast<double>(k);
  }
  State state(read), other(made);
  for (State* one : {&state, &other}) one->set_time_step(1e-6);  // inertia asks for it
  for (int step = 0; step < 2; ++step) {
    ASSERT_TRUE(state.evaluate(F, P, GRAINLAW_WANT_TANGENT_EXACT, A));
    ASSERT_TRUE(other.evaluate(F, other_P, GRAINLAW_WANT_TANGENT_EXACT, other_A));
    EXPECT_TRUE(same_bits(P, other_P));
    EXPECT_TRUE(same_bits(A, other_A));
    state.commit();
    other.load(state.save());  // states of one are those of the other
    F[square - 1] -= 1e-4;
  }
}

INSTANTIATE_TEST_SUITE_P(
    laws, saved_material,
    testing::Values(Law{"friction", "rve400.toml", ""},
                    Law{"drag", "rve400.toml", "[solver]\nviscous_number = 1e-3\n"},
                    Law{"inertia", "rve400.toml", "[solver]\ninertia = true\n"},
                    Law{"frame", "rve400.toml", "[boundary]\ntype = \"frame-p\"\n"},
                    Law{"locked_inside", "rve400.toml",
                        "[boundary]\ntype = \"frame-p\"\ninner_rotation = \"fixed\"\n"},
                    Law{"uniform_stress", "rve400.toml", "[boundary]\ntype = \"frame-t\"\n"},
                    Law{"bonds", "bonded100.toml", ""},
                    Law{"bond_springs", "bonded100.toml", "", springs},
                    Law{"spheres", "spheres500.toml", ""}),
    [](const auto& law) { return std::string(law.param.name); });

TEST(material_fingerprint, tells_any_other_key) {
  const std::string text = read_text(material_path);
  std::vector<unsigned long long> all{material().fingerprint(),
                                      Material::parse(text, data_directory).fingerprint()};
  EXPECT_EQ(all[0], all[1]);
  for (const char* more :
       {"[solver]\ntolerance = 1e-7\n", "[solver]\nviscous_number = 1e-3\n",
        "[solver]\ninertia = true\n", "[solver]\ncontacts_lost = \"stress_free\"\n",
        "[boundary]\ntype = \"frame-p\"\n",
        "[boundary]\ntype = \"frame-p\"\ninner_rotation = \"fixed\"\n"})
    all.push_back(Material::parse(text + more, data_directory).fingerprint());
  for (const char* of_bonds : {"", springs})
    all.push_back(Material::parse(text_of({"", "bonded100.toml", "", of_bonds}), data_directory)
                      .fingerprint());
  std::sort(all.begin(), all.end());
  EXPECT_EQ(std::unique(all.begin(), all.end()) - all.begin(), 9);
}

TEST(material_fingerprint, of_a_law_without_its_files) {
  const TemporaryDirectory directory;
  const Bytes bytes = [&] {
    for (const char* part :
         {"rve400.toml", "rve400_particles.csv", "rve400_contacts.csv", "rve400_cell.csv"})
      std::filesystem::copy(data_directory + "/" + part, directory / part);
    const Material there = Material::load((directory / "rve400.toml").string());
    for (const auto& file : std::filesystem::directory_iterator(directory / ""))
      std::filesystem::remove(file);
    return there.save();
  }();
  EXPECT_EQ(Material::load_saved(bytes).fingerprint(), material().fingerprint());
}

class bad_material_bytes : public testing::Test {
 protected:
  static void refused(const Bytes& bytes, grainlaw_status expected, const std::string& what) {
    std::array<char, 256> message{};
    auto* made = reinterpret_cast<grainlaw_material*>(&message);
    expect_refused(grainlaw_material_load_saved(bytes.data(), bytes.size(), &made, message.data(),
                                                message.size()),
                   expected, what);
    EXPECT_EQ(made, nullptr);
    EXPECT_STRNE(message.data(), "") << what;
  }
  Bytes saved_ = material().save();
};

TEST_F(bad_material_bytes, that_are_damaged_or_of_another_length_are_told) {
  for (std::size_t k = 0; k < saved_.size(); k += k < 64 ? 1 : 397) {
    Bytes damaged = saved_;
    damaged[k] ^= std::byte{16};
    refused(damaged, GRAINLAW_BAD_BYTES, "byte " + std::to_string(k));
    damaged = saved_;
    damaged.resize(k + 1);
    refused(damaged, GRAINLAW_BAD_BYTES, "length " + std::to_string(k + 1));
  }
  refused(State(material()).save(), GRAINLAW_BAD_BYTES, "of a state");
  Bytes other = saved_;
  other[8] ^= std::byte{1};
  seal(other);
  refused(other, GRAINLAW_WRONG_VERSION, "another version");
}

// With a checksum that is right.
TEST_F(bad_material_bytes, that_fit_together_no_more_are_told) {
  std::minstd_rand random(3);
  for (int k = 0; k < 300; ++k) {
    Bytes bytes = saved_;
    bytes.resize(20 + 8 * (random() % (bytes.size() / 8)));
    seal(bytes);
    refused(bytes, GRAINLAW_BAD_BYTES, "shorter");
  }
  Bytes bytes = saved_;
  bytes[12] = std::byte{3};
  seal(bytes);
  refused(bytes, GRAINLAW_BAD_BYTES, "of the other dimension");
}

TEST_F(bad_material_bytes, null_pointers_and_dead_handles_are_refused) {
  std::size_t size = 1;
  unsigned long long fingerprint = 0;
  grainlaw_material* made = nullptr;
  std::array<char, 4> short_one{};
  expect_refused(grainlaw_material_save(material().get(), short_one.data(), &size),
                 GRAINLAW_BUFFER_TOO_SMALL, "short");
  expect_refused(grainlaw_material_save(material().get(), nullptr, nullptr), GRAINLAW_NULL_POINTER,
                 "size");
  expect_refused(grainlaw_material_save(nullptr, nullptr, &size), GRAINLAW_NULL_POINTER, "save");
  expect_refused(grainlaw_material_fingerprint(material().get(), nullptr), GRAINLAW_NULL_POINTER,
                 "fingerprint");
  expect_refused(grainlaw_material_fingerprint(nullptr, &fingerprint), GRAINLAW_NULL_POINTER,
                 "material");
  expect_refused(grainlaw_material_load_saved(nullptr, 8, &made, nullptr, 0), GRAINLAW_NULL_POINTER,
                 "bytes");
  expect_refused(grainlaw_material_load_saved(saved_.data(), saved_.size(), nullptr, nullptr, 0),
                 GRAINLAW_NULL_POINTER, "out");
  alignas(16) std::array<std::uint64_t, 64> dead{};
  const auto* wrong = reinterpret_cast<grainlaw_material*>(dead.data());
  expect_refused(grainlaw_material_save(wrong, nullptr, &size), GRAINLAW_BAD_HANDLE, "dead");
  expect_refused(grainlaw_material_fingerprint(wrong, &fingerprint), GRAINLAW_BAD_HANDLE, "dead");
}

}  // namespace
}  // namespace grainlaw::test
