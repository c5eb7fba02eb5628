// `grainlaw_evidence liu2017_published`: T, P and D with the algorithms, gains and tolerances of the paper. Tables
// published_steps.csv, published_cases.csv and published_checks.csv; grainlaw_evidence liu2017_boundary reads them.

#include "app/material.hpp"
#include "app/progress.hpp"
#include "app/table.hpp"
#include "evidence/papers/liu2017_boundary/boundary.hpp"
#include "evidence/papers/liu2017_boundary/published/discs.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>

namespace verification {
namespace {

constexpr double friction = 0.4;
constexpr Matrix2 undeformed{1, 0, 0, 1};
constexpr std::array<int, 5> sizes{37, 120, 228, 444, 650};

PublishedDiscs discs(const std::filesystem::path& file, double pressure = 0,
                     double with_friction = friction) {
  MaterialSource source{file, file, file.parent_path(), {}};
  change(source, "boundary", "type", "frame-d");
  if (pressure > 0) change(source, "packing", "pressure", pressure);
  const MaterialText text = material_text(source);
  return {text.text, text.base, with_friction};
}

struct Path {
  int steps = 100;
  Matrix2 whole{0, 0.5, 0, 0};  // F - I at its end; eq. 40

  [[nodiscard]] Matrix2 at(int step) const {
    Matrix2 f = undeformed;
    for (std::size_t k = 0; k < 4; ++k) f[k] += whole[k] * step / steps;
    return f;
  }
};
const Path regular_path{300, {-0.03, -0.3, -0.3, -0.03}};  // eq. 38

double norm(const Matrix2& m) {
  double sum = 0;
  for (const double value : m) sum += value * value;
  return std::sqrt(sum);
}

// An increment from 1.2 of Table 3 or 2.3 of Table 2 on. Corrections until both residuals are within the
// tolerances; -1: they never are.
int correct_until_within(PublishedDiscs& packing, Rule rule, const Matrix2& f,
                         const PublishedValues& values) {
  if (!packing.relax(rule, values)) return -1;
  for (int correction = 1; correction <= values.max_corrections; ++correction) {
    packing.correct(rule, f, values);
    if (!packing.relax(rule, values)) return -1;
    const Residuals left = packing.residuals(rule, f, values);
    if (left.force <= values.force_tolerance &&
        (rule == Rule::P || left.deformation <= values.deformation_tolerance))
      return correction;
  }
  return -1;
}

// Table 3.
int without_prediction(PublishedDiscs& packing, Rule rule, const Path& path, int step,
                       const PublishedValues& values) {
  packing.lead(rule, path.at(step));
  return correct_until_within(packing, rule, path.at(step), values);
}

// Table 2.
int with_prediction(PublishedDiscs& packing, Rule rule, const Path& path, int step,
                    double inheritance, const PublishedValues& values) {
  if (step == 0)
    packing.lead(rule, path.at(0));
  else
    packing.predict(rule, path.at(step), path.at(step - 1), inheritance);
  return correct_until_within(packing, rule, path.at(step), values);
}

struct Tables {
  std::filesystem::path results;
  Table steps{"Published algorithms, step by step",
              {"case", "F12[-]", "corrections[-]", "relaxation_steps[-]", "r_a[-]", "r_F[-]",
               "frame_over_mean_force[-]", "inner_over_mean_force[-]", "off_F[-]",
               "mean_force_over_first[-]", "stress_norm[-]", "sigma11[-]", "sigma22[-]",
               "sigma12[-]", "direct_over_published[-]"}};
  Table cases{"Published algorithms: how far they go",
              {"case", "packing[-]", "pressure[kPa]", "increments[-]", "of[-]", "F12_reached[-]",
               "corrections_mean[-]", "largest_frame_over_mean_force[-]", "largest_off_F[-]",
               "direct_found[-]", "direct_tried[-]", "direct_apart_most[-]", "ended_by"}};
};

// Led as far as its servo ends, or so many steps times discs; every fifth state also given to direct relaxation under T.
void lead_case(Tables& tables, const std::string& name, int size, double pressure, Rule rule,
               PublishedDiscs packing, const Path& path, const PublishedValues& values,
               double most_work) {
  constexpr int every = 5, direct_steps = 60000;
  const double unit = packing.mean_radius() / packing.stiffness();
  int done = -1;
  const char* end = "path";
  double corrections = 0, first = 0, frame = 0, apart = 0, found = 0, tried = 0, farthest = 0;
  for (int step = 0;
       step <= path.steps &&
       static_cast<double>(packing.steps()) * static_cast<double>(packing.size()) < most_work;
       ++step) {
    const long before = packing.steps();
    const int count = without_prediction(packing, rule, path, step, values);
    if (count < 0) {
      end = "corrections";
      break;
    }
    const Matrix2 f = path.at(step), sigma = packing.cauchy(f);
    const Residuals left = packing.residuals(rule, f, values);
    if (step == 0) first = packing.mean_force();
    double direct = std::nan("");
    if (rule == Rule::T && step % every == 0) {
      PublishedDiscs other = packing;
      ++tried;
      if (other.relax_directly(f, direct_steps)) {
        ++found;
        direct = norm(other.cauchy(f)) / norm(sigma);
        farthest = std::max(farthest, std::abs(direct - 1));
      }
    }
    const double missing = rule == Rule::T ? packing.unbalanced_frame() : std::nan("");
    tables.steps.row({name, f[1], static_cast<double>(count),
                      static_cast<double>(packing.steps() - before), left.force, left.deformation,
                      missing, packing.unbalanced(), packing.off_deformation(f),
                      packing.mean_force() / first, unit * norm(sigma), unit * sigma[0],
                      unit * sigma[3], unit * sigma[1], direct});
    done = step, corrections += count;
    frame = std::fmax(frame, missing);
    apart = std::max(apart, packing.off_deformation(f));
  }
  tables.cases.row({name, fmt::format("{}", size), pressure / 1e3, static_cast<double>(done + 1),
                    static_cast<double>(path.steps + 1), done < 0 ? 0 : path.at(done)[1],
                    done < 0 ? std::nan("") : corrections / (done + 1), frame, apart, found, tried,
                    found > 0 ? farthest : std::nan(""),
                    done < path.steps && *end == 'p' ? "work" : end});
  fmt::print("{}: {} of {} increments\n", name, done + 1, path.steps + 1);
  tables.steps.write(tables.results / "published_steps.csv");
  tables.cases.write(tables.results / "published_cases.csv");
}

// Largest difference of P between Table 2 with n_f = 0 and Table 3 over the largest P.
double between_tables(const PublishedDiscs& start) {
  PublishedDiscs two = start, three = start;
  const PublishedValues values = values_of_irregular_packings();
  double apart = 0, largest = 0;
  for (int step = 0; step <= 3; ++step) {
    const int a = with_prediction(two, Rule::T, {}, step, 0, values),
              b = without_prediction(three, Rule::T, {}, step, values);
    if (a < 0 || b < 0) return std::nan("");
    const Matrix2 p = two.piola(), q = three.piola();
    for (std::size_t k = 0; k < 4; ++k) {
      apart = std::max(apart, std::abs(p[k] - q[k]));
      largest = std::max(largest, std::abs(q[k]));
    }
  }
  return apart / largest;
}

// Stress norm under D by the criterion Ek / Ep over that at a residual of 1e-6, to F12 = 0.1.
double of_criterion(const PublishedDiscs& start) {
  PublishedDiscs loose = start, tight = start;
  const PublishedValues values = values_of_irregular_packings();
  double apart = 0;
  for (int step = 1; step <= 20; ++step) {
    const Matrix2 f = Path{}.at(step);
    loose.lead(Rule::D, f);
    tight.lead(Rule::D, f);
    if (!loose.relax(Rule::D, values) || !tight.relax_tightly(Rule::D, 1e-6)) return std::nan("");
    apart = std::max(apart, std::abs(norm(loose.cauchy(f)) / norm(tight.cauchy(f)) - 1));
  }
  return apart;
}

// Energy of eq. 12 over that of the elastic part where no contact can slide.
double of_energies(PublishedDiscs packing) {
  double apart = 0;
  for (int step = 1; step <= 5; ++step) {
    packing.lead(Rule::D, Path{}.at(step));
    if (!packing.relax_tightly(Rule::D, 1e-6)) return std::nan("");
    apart = std::max(apart, std::abs(packing.stored(true) / packing.stored(false) - 1));
  }
  return apart;
}

void run(const std::filesystem::path& scenes, const std::filesystem::path& results) {
  const auto file = [&](const std::string& name) { return scenes / (name + ".toml"); };
  Tables tables{results};
  Table checks("Published algorithms: checks", {"check", "value"});
  const auto rough = [&](int size, double pressure, double with_friction = friction) {
    return discs(file(fmt::format("pack_{}", size)), pressure, with_friction);
  };
  checks.row({"table_2_less_table_3", between_tables(rough(120, 100e3))});
  checks.row({"criterion_apart", of_criterion(rough(228, 10e3))});
  checks.row({"whole_over_elastic_energy", of_energies(rough(37, 10e3, 1e9))});
  checks.print();
  checks.write(results / "published_checks.csv");
  // Gains of the irregular packings, and to see how far their tolerances lead, those of the regular ones.
  const PublishedDiscs square = discs(file("pack_square_25"));
  const PublishedValues values = values_of_irregular_packings();
  PublishedValues fast = values;
  fast.gain_force_of_t = PublishedValues().gain_force_of_t;
  fast.gain_deformation = PublishedValues().gain_deformation;
  constexpr double little = 5e8, much = 2.5e9;
  lead_case(tables, "P_regular", 25, 0, Rule::P, square, regular_path, {}, much);
  lead_case(tables, "T_regular", 25, 0, Rule::T, square, regular_path, {}, much);
  lead_case(tables, "P_228", 228, 10e3, Rule::P, rough(228, 10e3), {}, values, much);
  for (const int size : sizes)
    for (const double pressure : {10e3, 100e3}) {
      const PublishedDiscs packing = rough(size, pressure);
      const auto name = [&](const char* kind) {
        return fmt::format("{}_{}_{}kPa", kind, size, pressure / 1e3);
      };
      if (size <= 228)
        lead_case(tables, name("T"), size, pressure, Rule::T, packing, {}, values, little);
      lead_case(tables, name("T_fast"), size, pressure, Rule::T, packing, {}, fast, much);
    }
  tables.cases.print();
}

}  // namespace

void add_liu2017_published_study(CLI::App& app, const std::shared_ptr<StudyOptions>& options) {
  CLI::App* command = app.add_subcommand(
      "liu2017_published", "D, P and T with the algorithms, gains and tolerances of the paper");
  command->callback([options] {
    run(std::filesystem::path(options->scenes) / "liu2017_boundary", options->output);
  });
}

}  // namespace verification
