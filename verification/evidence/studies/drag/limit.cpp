#include "evidence/studies/drag/findings.hpp"
#include "evidence/studies/drag/host.hpp"
#include "evidence/studies/drag/sections.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace verification::drag {
namespace {

constexpr double coarsest = 4e-3;                              // strain of a step
constexpr std::array<int, 6> refinements{1, 2, 4, 8, 16, 32};  // of it
constexpr double least_order = 1;                              // of successive differences
constexpr double largest_rise = 1.0 / 3;                       // of the unbalanced force
constexpr double largest_uneven = 0.1;                         // of q [%]
constexpr double peak_end = 0.06, late = 0.03;                 // after the peak: from, to

// Paths in multiples of the coarsest step.
struct Path {
  const char* name;
  std::vector<int> reversals;  // strain at the end of each part
};
const std::vector<Path>& paths_of_strain() {
  static const std::vector<Path> paths{{"isochoric", {4}}, {"cyclic", {2, -2, 2}}};
  return paths;
}

// Deviators at multiples of the coarsest step.
struct Answers {
  std::vector<double> q;
  double unbalanced = 0;  // mean of the steps
};

template <int D>
Answers strain_path(const Material& material, const Path& path, int refinement) {
  Host<D> host(material);
  Answers answers;
  int level = 0;
  for (const int reversal : path.reversals) {
    for (const int direction = reversal > level ? 1 : -1; level != reversal; level += direction) {
      for (int k = 1; k <= refinement; ++k) {
        const double to = level + direction * static_cast<double>(k) / refinement;
        if (!host.lead(isochoric<D>(coarsest * to))) return answers;
      }
      answers.q.push_back(host.q());
    }
  }
  answers.unbalanced = average(host.unbalanced);
  return answers;
}

template <int D>
Answers drained_path(const Material& material, int refinement) {
  constexpr int steps = 4;
  const Drained path = drained<D>(material, steps * coarsest, steps * refinement, {});
  Answers answers;
  for (int k = refinement; k <= path.steps; k += refinement)
    answers.q.push_back(path.stress[static_cast<std::size_t>(k)] - pressure);
  answers.unbalanced = average(path.unbalanced);
  return answers;
}

// Square root of the mean square of a - b over that of b [%].
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size() || a.empty()) return told;
  double squares = 0, size = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    squares += std::pow(a[k] - b[k], 2);
    size += b[k] * b[k];
  }
  return 100 * std::sqrt(squares / size);
}

// What one packing gave along a path, or the root mean squares and means of several.
struct Refined {
  std::vector<double> apart;       // each step against half as large ones, then by a nudge [%]
  std::vector<double> unbalanced;  // of each step [%]
};

Refined mean_of(const std::vector<Refined>& all) {
  Refined mean = all.front();
  const auto count = static_cast<double>(all.size());
  for (std::size_t k = 0; k < mean.apart.size(); ++k) {
    double squares = 0;
    for (const Refined& one : all) squares += one.apart[k] * one.apart[k];
    mean.apart[k] = std::sqrt(squares / count);
  }
  for (std::size_t k = 0; k < mean.unbalanced.size(); ++k) {
    mean.unbalanced[k] = 0;
    for (const Refined& one : all) mean.unbalanced[k] += one.unbalanced[k] / count;
  }
  return mean;
}

void add_row(Findings& findings, const std::string& packing, const std::string& path,
             const Refined& found) {
  std::vector<Table::Cell> facts{packing, path};
  for (const double apart : found.apart) facts.emplace_back(apart);
  for (const double unbalanced : found.unbalanced) facts.emplace_back(unbalanced);
  const double last = found.apart[refinements.size() - 2];
  const double halvings = static_cast<double>(refinements.size()) - 2;
  findings.row(facts, {{std::log2(found.apart.front() / last) / halvings, least_order},
                       {found.unbalanced.back() / found.unbalanced.front() - 1, largest_rise}});
}

// `run(material, refinement)`: answers.
template <class Run>
Refined refined(Study& study, Packing packing, Run&& run) {
  std::vector<Answers> answers;
  const Material material = study.materials(packing, {});
  for (const int refinement : refinements) answers.push_back(run(material, refinement));
  packing.repeat = 1;
  answers.push_back(run(study.materials(packing, {}), refinements.back()));
  Refined found;
  for (std::size_t k = 0; k + 1 < answers.size(); ++k) {
    found.apart.push_back(difference(answers[k].q, answers[k + 1].q));
    found.unbalanced.push_back(100 * answers[k].unbalanced);
  }
  return found;
}

void refine(Study& study) {
  std::vector<std::string> facts{"packing", "path"};
  for (std::size_t k = 0; k + 1 < refinements.size(); ++k)
    facts.push_back(fmt::format("apart_{:g}[%]", 100 * coarsest / refinements[k]));
  facts.emplace_back("nudged[%]");
  for (const int refinement : refinements)
    facts.push_back(fmt::format("unbalanced_{:g}[%]", 100 * coarsest / refinement));
  Findings findings(study.options(), "limit",
                    "steps of the named size [%] against half as large ones: q apart, as root mean "
                    "squares, and by a nudge of 1e-6 of the stiffness in the finest; its order; "
                    "unbalanced force and its rise to the finest",
                    facts, {{"order[-]", true}, {"rise[-]"}});
  for (const std::vector<Packing>& packings :
       {discs(study.packings(5)), spheres(study.packings(2))}) {
    std::map<std::string, std::vector<Refined>> all;  // by paths
    for (const Packing& packing : packings) {
      in_dimension(packing.dimension, [&](auto dimension) {
        constexpr int D = dimension;
        const auto each = [&](const std::string& name, auto&& run) {
          all[name].push_back(refined(study, packing, run));
          add_row(findings, packing.name(), name, all[name].back());
        };
        for (const Path& path : paths_of_strain())
          each(path.name, [&](const Material& material, int refinement) {
            return strain_path<D>(material, path, refinement);
          });
        each("drained", drained_path<D>);
      });
    }
    for (const auto& [name, found] : all)
      add_row(findings,
              fmt::format("{} {}", found.size(), packings[0].dimension == 2 ? "discs" : "spheres"),
              name, mean_of(found));
  }
  findings.print();
}

// Means of several packings after the peak, against those of the finest steps.
void refine_beyond_peak(Study& study) {
  Findings findings(study.options(), "limit_peak",
                    "axial stress over 3 to 6 %, drained, mean of the packings and its standard "
                    "error; apart from the finest steps, over the standard error of both",
                    {"packings", "step[%]", "mean[kPa]", "s.e.[kPa]", "ended[-]"}, {{"apart[-]"}});
  const std::vector<Packing> packings = discs(study.packings(5));
  std::vector<double> finest;
  for (std::size_t r = refinements.size(); r-- > 0;) {
    std::vector<double> means;
    int ended = 0;
    const int steps = static_cast<int>(std::lround(peak_end / coarsest * refinements[r]));
    for (const Packing& packing : packings) {
      const Drained path = drained<2>(study.materials(packing, {}), peak_end, steps, {});
      ended += path.failure.empty() ? 1 : 0;
      means.push_back(1e-3 * path.mean_between(late, peak_end));
    }
    if (finest.empty()) finest = means;
    const double both = std::hypot(standard_error(means), standard_error(finest));
    const bool is_finest = r + 1 == refinements.size();
    findings.row({fmt::format("{} discs", packings.size()),
                  fmt::format("{:g}", 100 * coarsest / refinements[r]), average(means),
                  standard_error(means), static_cast<double>(ended)},
                 {{std::abs(average(means) - average(finest)) / both, is_finest ? told : 1}});
  }
  findings.print();
}

// q along a path of steps in parts, less that of whole steps [%]: the mean, and root mean square.
template <int D>
std::array<double, 2> uneven(const Material& material, const std::vector<double>& parts) {
  constexpr double step = 1e-3;
  constexpr int steps = 15;
  Host<D> whole(material), divided(material);
  std::vector<double> a, b;
  for (int k = 0; k < steps; ++k) {
    if (!whole.lead(isochoric<D>(step * (k + 1)))) return {told, told};
    double done = 0;
    for (const double part : parts) {
      done += part;
      if (!divided.lead(isochoric<D>(step * (k + done)), part)) return {told, told};
    }
    a.push_back(divided.q());
    b.push_back(whole.q());
  }
  return {100 * (average(a) / average(b) - 1), difference(a, b)};
}

void divide(Study& study) {
  Findings findings(study.options(), "limit_uneven",
                    "steps of 0.1 % in uneven parts, against whole ones, isochoric to 1.5 %",
                    {"packing", "parts", "q_apart[%]", "root_mean_square[%]"}, {{"size[%]"}});
  const std::vector<std::pair<std::string, std::vector<double>>> divisions{
      {"1:1", {0.5, 0.5}},    {"1:2", {1.0 / 3, 2.0 / 3}},
      {"1:9", {0.1, 0.9}},    {"1:99", {0.01, 0.99}},
      {"99:1", {0.99, 0.01}}, {"cut twice and back", {0.25, 0.25, 0.5}}};
  std::vector<Packing> packings = discs(study.packings(5));
  for (const Packing& packing : spheres(study.packings(2))) packings.push_back(packing);
  for (const Packing& packing : packings) {
    in_dimension(packing.dimension, [&](auto dimension) {
      const Material material = study.materials(packing, {});
      for (const auto& [name, parts] : divisions) {
        const auto [mean, root] = uneven<dimension>(material, parts);
        findings.row({packing.name(), name, mean, root},
                     {{std::abs(mean), name == "1:1" ? told : largest_uneven}});
      }
    });
  }
  findings.print();
}

}  // namespace

void measure_limit(Study& study) {
  refine(study);
  divide(study);
  refine_beyond_peak(study);
}

}  // namespace verification::drag
