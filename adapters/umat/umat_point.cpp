// One call of UMAT: the state that STATEV(1) names, the packing's answer, Cauchy stress and DDSDDE.
#include "floating_environment.hpp"
#include "material_file.hpp"
#include "point.hpp"
#include "told_once.hpp"
#include "whole_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace grainlaw::adapters {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::size_t, 6> order{0, 4, 8, 1, 2, 5};  // 11 22 33 12 13 23

// The working directory of the job.
const fs::path job_folder = [] {
  std::error_code failed;
  return fs::current_path(failed);
}();

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return text;
}

// An increment of the host.
struct Increment {
  int step, number;
};

// A material by the name that the host has for it, and its points.
class UserMaterial {
 public:
  explicit UserMaterial(std::string name)
      : name_(std::move(name)),
        file_(name_.c_str(), (job_folder / (lower_case(name_) + ".toml")).c_str(), &order) {}

  // The points, from their file after a restart.
  grainlaw::Table& table(const std::optional<Increment>& restart) {
    const grainlaw::Material& material = file_.material();
    const std::lock_guard lock(mutex_);
    if (!table_) {
      grainlaw::Table made(material);
      if (restart) load(made, path(*restart));
      table_.emplace(std::move(made));
    }
    return *table_;
  }
  void save(const Increment& at) {
    const std::lock_guard lock(mutex_);
    if (!table_) return;
    const std::vector<std::byte> bytes = table_->save();
    WholeFile file(path(at));
    file.write(bytes.data(), bytes.size());
    file.keep();
  }
  [[nodiscard]] const char* name() const { return name_.c_str(); }

 private:
  [[nodiscard]] std::string path(const Increment& at) const {
    return job_folder / (lower_case(name_) + "_" + std::to_string(at.step) + "_" +
                         std::to_string(at.number) + ".points");
  }
  static void load(grainlaw::Table& table, const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
    if (!stream.good() && !stream.eof()) throw std::runtime_error(path + ": cannot be read");
    try {
      table.load(std::as_bytes(std::span(bytes)));
    } catch (const grainlaw::StatusError& error) {
      throw std::runtime_error(path + ": " + error.what());
    }
  }

  std::string name_;
  MaterialFile file_;
  std::mutex mutex_;
  std::optional<grainlaw::Table> table_;
};

class Job {
 public:
  ToldOnce errors;

  UserMaterial& material(const std::string& name) {
    const std::lock_guard lock(mutex_);
    std::unique_ptr<UserMaterial>& found = materials_[name];
    if (!found) found = std::make_unique<UserMaterial>(name);
    return *found;
  }
  [[nodiscard]] std::optional<Increment> restart() const {
    const std::lock_guard lock(mutex_);
    return restart_;
  }
  void restart_from(const Increment& at) {
    const std::lock_guard lock(mutex_);
    materials_.clear();
    restart_ = at;
  }
  void save(const Increment& at) {
    const std::lock_guard lock(mutex_);
    for (const auto& [name, material] : materials_) material->save(at);
  }
  void release() {
    const std::lock_guard lock(mutex_);
    materials_.clear();
    restart_.reset();
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::unique_ptr<UserMaterial>> materials_;
  std::optional<Increment> restart_;
};

Job& job() {
  static Job one;
  return one;
}

Tensor2 from_columns(const double* F) {
  return {F[0], F[3], F[6], F[1], F[4], F[7], F[2], F[5], F[8]};
}

// Components of a stress with three direct and one or three shear components.
void write(const Response& response, int shears, double* stress, double* ddsdde) {
  const Tensor2 cauchy = cauchy_stress(response);
  Tensor4 tangent;
  jaumann_rate(response, tangent);
  const auto size = static_cast<std::size_t>(3 + shears);
  for (std::size_t a = 0; a < size; ++a) {
    stress[a] = cauchy[order[a]];
    for (std::size_t b = 0; b < size; ++b) {
      ddsdde[a + size * b] = tangent[9 * order[a] + order[b]];
    }
  }
}

}  // namespace
}  // namespace grainlaw::adapters

extern "C" {

// UMAT without what it does not use; F0, F1[9] column by column, ddsdde[ntens, ntens] too. Asks for a
// smaller increment by pnewdt, and then writes nothing else; what is wrong is printed once.
void grainlaw_umat_point(const char* material, int element, int point, const double* F0,
                         const double* F1, double dtime, int direct, int shears, double* token,
                         double* stress, double* ddsdde, double* pnewdt) {
  using namespace grainlaw::adapters;
  const FloatingEnvironment environment;
  const auto cut = [&](double ratio) { *pnewdt = std::min(*pnewdt, ratio); };
  try {
    if (direct != 3 || (shears != 1 && shears != 3)) {
      throw std::runtime_error(
          "NDI = " + std::to_string(direct) + " and NSHR = " + std::to_string(shears) +
          "; plane strain (3 and 1) or three dimensions (3 and 3) were expected");
    }
    grainlaw::Table& table = job().material(material).table(job().restart());
    if (table.dimension() == 3 && shears != 3) {
      throw std::runtime_error(
          "a packing of spheres needs elements of three dimensions (NTENS = 6)");
    }
    const Tensor2 start = from_columns(F0), end = from_columns(F1);
    Response response;
    const Answer answer =
        evaluate_symmetric(table,
                           {element, point, token, *token == 0 ? nullptr : &start, &end,
                            time_step_of(dtime), GRAINLAW_WANT_TANGENT_EXACT},
                           response);
    if (answer.status != GRAINLAW_OK) {
      return cut(grainlaw_march_cut(answer.report.step_ratio));
    }
    write(response, shears, stress, ddsdde);
  } catch (const std::exception& error) {
    cut(grainlaw_march_cut(NAN));  // no ratio was suggested
    try {
      job().errors.tell(material, "element " + std::to_string(element) + ", point " +
                                      std::to_string(point) + ": " + error.what());
    } catch (const std::exception&) {  // no memory for the text
    }
  }
}

// UEXTERNALDB: lop 2 and restart > 0: write the points; 3: the end; 4: read them, of this increment.
void grainlaw_umat_event(int lop, int restart, int step, int increment) {
  using namespace grainlaw::adapters;
  const FloatingEnvironment environment;
  try {
    if (lop == 2 && restart > 0) job().save({step, increment});
    if (lop == 3) job().release();
    if (lop == 4) job().restart_from({step, increment});
  } catch (const std::exception& error) {
    try {
      job().errors.tell("of this job", error.what());
    } catch (const std::exception&) {
    }
  }
}

}  // extern "C"
