// Leads representative volumes along short paths and tells every answer as a hash of all its bits:
// P, A, report, measures and the committed bytes. `answers` prints them; `answers FILE` compares with
// those of a file and names the first that differs in every path.
#include <grainlaw/grainlaw.hpp>

#include <xxhash.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <span>
#include <sstream>
#include <string>
#include <vector>

namespace {

using grainlaw::Material;
using grainlaw::State;
using Tensor = std::array<double, 4>;

struct Answer {
  std::string path;
  std::string text;  // place in it, hash, and P for a person
};

class Hash {
 public:
  Hash() { XXH3_64bits_reset(state_); }
  ~Hash() { XXH3_freeState(state_); }
  Hash(const Hash&) = delete;
  Hash& operator=(const Hash&) = delete;

  template <class Value>
  void add(std::span<const Value> values) {
    XXH3_64bits_update(state_, values.data(), values.size_bytes());
  }
  template <class Value>
  void add(const Value& value) {
    add(std::span<const Value>(&value, 1));
  }
  [[nodiscard]] std::uint64_t value() const { return XXH3_64bits_digest(state_); }

 private:
  XXH3_state_t* state_ = XXH3_createState();
};

void add(Hash& hash, const grainlaw_report& report) {
  hash.add(report.residual);
  hash.add(report.step_ratio);
  hash.add(report.relaxation_steps);
  hash.add(report.servo_corrections);
  for (const int number : {report.factorisations, report.subincrements, report.contacts,
                           report.sliding, report.status_changes, report.tangent_exact,
                           report.history_advanced, report.broken_bonds}) {
    hash.add(number);
  }
  const std::string message = report.message;
  hash.add(std::span<const char>(message));
}

void add_measures(Hash& hash, const State& state) {
#define GRAINLAW_X(name, value, count, text) hash.add(std::span<const double>(state.measure(name)));
  GRAINLAW_MEASURE_LIST(GRAINLAW_X)
#undef GRAINLAW_X
}

// One representative volume on its way.
class Path {
 public:
  Path(std::string name, const std::string& toml, std::vector<Answer>& answers)
      : name_(std::move(name)),
        state_(Material::parse(toml, GRAINLAW_TEST_DATA)),
        answers_(answers) {}

  void go_to(const Tensor& F, unsigned want = GRAINLAW_WANT_TANGENT_EXACT) {
    try_out(F, want);
    if (found_) state_.commit();
    hash_state();
  }

  void try_out(const Tensor& F, unsigned want = GRAINLAW_WANT_TANGENT_EXACT) {
    Tensor P{};
    std::array<double, 16> A{};
    const auto result = state_.evaluate(F, P, want, A);
    found_ = static_cast<bool>(result);
    Hash hash;
    hash.add(static_cast<int>(result.status));
    hash.add(std::span<const double>(P));
    hash.add(std::span<const double>(A));
    add(hash, result.report);
    add_measures(hash, state_);
    char numbers[200];
    std::snprintf(numbers, sizeof numbers, "%2d %016llx status %d P %.10g %.10g %.10g %.10g",
                  step_++, static_cast<unsigned long long>(hash.value()), result.status, P[0], P[1],
                  P[2], P[3]);
    answers_.push_back({name_, numbers});
  }

  void revert() { state_.revert(); }

 private:
  void hash_state() {
    Hash hash;
    hash.add(std::span<const std::byte>(state_.save()));
    char number[40];
    std::snprintf(number, sizeof number, "%2d %016llx committed", step_++,
                  static_cast<unsigned long long>(hash.value()));
    answers_.push_back({name_, number});
  }

  std::string name_;
  State state_;
  std::vector<Answer>& answers_;
  bool found_ = false;
  int step_ = 0;
};

const std::string drained_packing = R"(
dimension = 2
[packing]
particles = "rve400_particles.csv"
contacts = "rve400_contacts.csv"
cell = "rve400_cell.csv"
)";
const std::string made_packing = R"(
dimension = 2
thickness = 0.1
[packing]
generator = "compaction"
count = 80
radii = [0.004, 0.008]
seed = 3
pressure = 1e5
friction = 0.2
)";
// Held by large overlaps, so that discs of a frame under uniform stress keep their contacts.
const std::string firm_packing = R"(
dimension = 2
thickness = 0.1
[packing]
generator = "compaction"
count = 60
radii = [0.004, 0.006]
seed = 4
pressure = 4e6
)";
const std::string sand = R"(
[contact]
law = "frictional"
young = 6e8
ratio = 0.8
friction = 0.5
)";
const std::string firm_bonds =
    "bond = { normal_strength = 400, tangential_strength = 400, bending_stiffness = 200, "
    "bending_strength = 2 }\n";

std::string boundary(const std::string& keys) { return "[boundary]\n" + keys + "\n"; }
std::string solver(const std::string& keys) { return "[solver]\n" + keys + "\n"; }

const std::string layer =
    "type = \"mixed\"\n"
    "left = { x = \"P\", y = \"P\", rotation = \"periodic\" }\n"
    "right = { x = \"P\", y = \"P\", rotation = \"periodic\" }\n"
    "bottom = { x = \"D\", y = \"D\", rotation = \"fixed\" }\n"
    "top = { x = \"D\", y = \"T\", rotation = \"free\" }\n";

// Shortens in y by so much a step, and widens in x by a share of it.
void biaxial(Path& path, int steps, double by, double share = 0.3) {
  for (int k = 1; k <= steps; ++k) path.go_to({1 + share * by * k, 0, 0, 1 - by * k});
}

void shear(Path& path, int steps, double by) {
  for (int k = 1; k <= steps; ++k) path.go_to({1, by * k, 0, 1});
}

void isochoric_cycle(Path& path, int quarter, double amplitude) {
  for (int k = 1; k <= 4 * quarter; ++k) {
    const int in_turn = k <= quarter ? k : k <= 3 * quarter ? 2 * quarter - k : k - 4 * quarter;
    const double a = amplitude * in_turn / quarter;
    path.go_to({std::exp(a), 0, 0, std::exp(-a)});
  }
}

// A step too large, taken back, and taken in parts; from a trial again, and with other tangents.
void cut_steps(Path& path) {
  path.try_out({1.002, 0, 0, 0.99});
  path.revert();
  path.go_to({1.001, 0, 0, 0.995});
  path.try_out({1.0015, 1e-3, 0, 0.9945});
  path.try_out({1.0015, 1.1e-3, 0, 0.9945});
  path.go_to({1.0015, 1.1e-3, 2e-4, 0.9944}, GRAINLAW_WANT_TANGENT_ELASTIC);
  path.go_to({1.0016, 1.2e-3, 2e-4, 0.9943}, GRAINLAW_WANT_TANGENT_PERTURBED);
  path.try_out({1.6, 0, 0, 1});
  path.go_to({1.0016, 0.4, -0.3, 0.9943});
}

std::vector<Answer> find_answers() {
  std::vector<Answer> all;
  const auto on = [&](const char* name, const std::string& toml,
                      const std::function<void(Path&)>& lead) {
    Path path(name, toml, all);
    lead(path);
  };
  const std::string locked = sand + "rotation = false\n";
  const std::string rolling = sand + "rolling = { ratio = 0.5, friction = 0.1 }\n";
  const std::string compressive = "[contact]\nlaw = \"compressive\"\nyoung = 6e8\n";
  const std::string hertz =
      "[contact]\nlaw = \"hertz\"\nshear_modulus = 29e9\npoisson = 0.2\nfriction = 0.5\n";
  const std::string bonded =
      "[contact]\nlaw = \"bonded\"\nyoung = 6e8\nratio = 0.8\nfriction = 0.5\n" + firm_bonds;

  on("cell/frictional/biaxial", drained_packing + sand, [](Path& p) { biaxial(p, 8, 1e-3); });
  on("cell/frictional/shear", made_packing + sand, [](Path& p) { shear(p, 50, 1e-2); });
  on("cell/frictional/cycle", made_packing + sand, [](Path& p) { isochoric_cycle(p, 3, 2e-3); });
  on("cell/frictional/cut", drained_packing + sand, cut_steps);
  on("cell/frictional/trial", drained_packing + sand + solver("start = \"trial\""), cut_steps);
  on("cell/frictional/loose", made_packing + sand + solver("loose_tolerance = 1e-3"),
     [](Path& p) { biaxial(p, 4, 3e-3); });
  on("cell/frictional/advancing", made_packing + sand + solver("method = \"advancing\""),
     [](Path& p) { biaxial(p, 2, 1e-3); });
  on("cell/frictional/published",
     made_packing + sand + solver("method = \"published\"\ntolerance = 1e-4"),
     [](Path& p) { biaxial(p, 1, 1e-3); });
  on("cell/frictional/lost_and_found",
     made_packing + sand + solver("contacts_lost = \"stress_free\""), [](Path& p) {
       for (const double a : {1.001, 1.01, 1.02, 1.005, 1.0, 0.999}) p.go_to({a, 0, 0, a});
     });
  on("cell/locked", made_packing + locked, [](Path& p) { biaxial(p, 5, 2e-3); });
  on("cell/rolling", made_packing + rolling, [](Path& p) { biaxial(p, 5, 2e-3); });
  on("cell/compressive", made_packing + compressive, [](Path& p) { biaxial(p, 4, 1e-3); });
  on("cell/hertz", made_packing + hertz, [](Path& p) { biaxial(p, 5, 1e-4); });
  on("cell/hertz/cycle", made_packing + hertz + "rolling = { ratio = 0.5, friction = 0.1 }\n",
     [](Path& p) { isochoric_cycle(p, 2, 2e-4); });
  on("cell/hertz/locked", made_packing + hertz + "rotation = false\n",
     [](Path& p) { biaxial(p, 3, 1e-4); });
  on("cell/bonded", made_packing + bonded, [](Path& p) { biaxial(p, 8, 1e-3, 1.0); });
  on("cell/bonded/locked",
     made_packing +
         "[contact]\nlaw = \"bonded\"\nyoung = 6e8\nratio = 0.8\nfriction = 0.5\nrotation = false\n"
         "bond = { normal_strength = 400, tangential_strength = 400 }\n",
     [](Path& p) { biaxial(p, 4, 1e-3, 1.0); });
  on("cell/growth",
     "dimension = 2\nthickness = 0.1\n[packing]\ngenerator = \"lubachevsky-stillinger\"\ncount = "
     "60\n"
     "radii = [0.004, 0.006]\nseed = 5\nvoid_ratio = 0.15\n" +
         sand,
     [](Path& p) { biaxial(p, 3, 1e-3); });
  on("frame-d", made_packing + sand + boundary("type = \"frame-d\""),
     [](Path& p) { biaxial(p, 4, 1e-3); });
  on("frame-p", made_packing + sand + boundary("type = \"frame-p\""),
     [](Path& p) { biaxial(p, 4, 1e-3); });
  on("frame-p/bonded", made_packing + bonded + boundary("type = \"frame-p\""),
     [](Path& p) { biaxial(p, 3, 1e-3, 1.0); });
  on("frame-t", firm_packing + sand + boundary("type = \"frame-t\""),
     [](Path& p) { biaxial(p, 4, 1e-3); });
  on("frame-p/servo",
     firm_packing + sand + boundary("type = \"frame-p\"\nmethod = \"servo\"") +
         solver("tolerance = 1e-3"),
     [](Path& p) { biaxial(p, 1, 1e-4); });
  on("mixed/layer", firm_packing + sand + boundary(layer), [](Path& p) { shear(p, 4, 1e-3); });
  on("mixed/layer/stress", firm_packing + sand + boundary(layer + "stress = { P22 = -1e5 }"),
     [](Path& p) { shear(p, 4, 1e-3); });
  return all;
}

std::map<std::string, std::vector<std::string>> by_paths(const std::vector<Answer>& answers) {
  std::map<std::string, std::vector<std::string>> result;
  for (const Answer& answer : answers) result[answer.path].push_back(answer.text);
  return result;
}

std::vector<Answer> read(const char* file) {
  std::ifstream in(file);
  std::vector<Answer> answers;
  for (std::string line; std::getline(in, line);) {
    const auto space = line.find(' ');
    if (space != std::string::npos)
      answers.push_back({line.substr(0, space), line.substr(space + 1)});
  }
  return answers;
}

int compare(const std::vector<Answer>& found, const std::vector<Answer>& expected) {
  const auto of_file = by_paths(expected);
  const auto here = by_paths(found);
  int differing = 0;
  for (const auto& [path, answers] : here) {
    const auto known = of_file.find(path);
    for (std::size_t k = 0; k < answers.size(); ++k) {
      const std::string before =
          known != of_file.end() && k < known->second.size() ? known->second[k] : "(none)";
      if (answers[k] == before) continue;
      ++differing;
      std::printf("%s differs first at\n  expected %s\n  found    %s\n", path.c_str(),
                  before.c_str(), answers[k].c_str());
      break;
    }
  }
  for (const auto& [path, answers] : of_file) {
    if (here.contains(path) && here.at(path).size() == answers.size()) continue;
    ++differing;
    std::printf("%s: %zu answers expected, found %zu\n", path.c_str(), answers.size(),
                here.contains(path) ? here.at(path).size() : 0);
  }
  std::printf("%zu of %zu paths have the same bits\n",
              here.size() - static_cast<std::size_t>(differing), here.size());
  return differing == 0 && !expected.empty() ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
  try {
    const auto found = find_answers();
    if (count == 2) return compare(found, read(arguments[1]));
    for (const Answer& answer : found)
      std::printf("%s %s\n", answer.path.c_str(), answer.text.c_str());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "answers: %s\n", error.what());
    return 1;
  }
}
