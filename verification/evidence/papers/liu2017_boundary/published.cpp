// T as published: how far it goes, what its tolerances leave, and the same states under direct relaxation.

#include "evidence/papers/liu2017_boundary/boundary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace verification {
namespace {

constexpr std::array<const char*, 5> colours{colour::blue, colour::orange, colour::green,
                                             colour::purple, colour::amber};
constexpr std::array<int, 5> sizes{37, 120, 228, 444, 650};

// Columns of one case of published_steps.csv.
using Columns = std::map<std::string, std::vector<double>>;

Columns rows_of(const CsvTable& table, const CaseEnds& names, const std::string& wanted) {
  Columns found;
  for (std::size_t k = 0; k < table.rows(); ++k)
    if (names.name[k] == wanted)
      for (std::size_t c = 0; c < table.names.size(); ++c)
        found[table.names[c]].push_back(table.columns[c][k]);
  return found;
}

void draw_steps(const PaperStudy& study, const CaseEnds& steps) {
  for (const int pressure : {10, 100}) {
    Panel norm{"|σ R / kn| [-]", {}, 1.3},
        frame{"unbalanced on the frame / mean force [-]", {}, 1, true},
        apart{"|mean F - F| [-]", {}, 1, true};
    for (std::size_t s = 0; s < sizes.size(); ++s) {
      Columns rows =
          rows_of(steps.table, steps, fmt::format("T_fast_{}_{}kPa", sizes[s], pressure));
      if (rows["F12"].empty()) continue;
      const std::string title = fmt::format("{} discs", sizes[s]);
      norm.curves.push_back({title, rows["F12"], rows["stress_norm"], colours[s], Stroke::solid});
      frame.curves.push_back(
          {"", rows["F12"], rows["frame_over_mean_force"], colours[s], Stroke::solid});
      apart.curves.push_back({"", rows["F12"], rows["off_F"], colours[s], Stroke::solid});
      std::vector<double> at, direct;
      for (std::size_t k = 0; k < rows["F12"].size(); ++k)
        if (std::isfinite(rows["direct_over_published"][k])) {
          at.push_back(rows["F12"][k]);
          direct.push_back(rows["direct_over_published"][k] * rows["stress_norm"][k]);
        }
      if (!at.empty())
        norm.curves.push_back(
            {s == 0 ? "directly" : "", at, direct, colours[s], Stroke::dashed, 7});
    }
    if (norm.curves.empty()) continue;
    draw({fmt::format("T as published, from {} kPa; points: the same under direct relaxation",
                      pressure),
          "F12 [-]",
          {norm, frame, apart}},
         study.results / fmt::format("published_T_{}kPa", pressure));
  }
}

}  // namespace

void study_published(PaperStudy& study) {
  const CaseEnds cases(study.results / "published_cases.csv"),
      steps(study.results / "published_steps.csv"), checks(study.results / "published_checks.csv");
  if (cases.name.empty()) return;
  const auto check = [&](const char* name) {
    const auto k = checks.find(name);
    return k ? checks.table["value"][*k] : std::nan("");
  };
  study.facts.add("published.table_2_less_table_3", check("table_2_less_table_3"));
  study.facts.add("published.criterion_apart", check("criterion_apart"));
  study.facts.add("published.whole_over_elastic_energy", check("whole_over_elastic_energy"));
  double ended = 1, reached = INFINITY, found = 0, tried = 0, frame = 0;
  int irregular = 0;
  for (const std::string& name : cases.name) {
    const std::size_t k = *cases.find(name);
    const double share = cases.table["increments"][k] / cases.table["of"][k];
    study.facts.add(fmt::format("published.{}.reached", name), cases.table["F12_reached"][k]);
    study.facts.add(fmt::format("published.{}.corrections", name),
                    cases.table["corrections_mean"][k]);
    if (!name.starts_with("T_") || name == "T_regular") ended = std::min(ended, share);
    if (!name.starts_with("T_fast")) continue;
    ++irregular;
    reached = std::min(reached, cases.table["F12_reached"][k]);
    found += cases.table["direct_found"][k], tried += cases.table["direct_tried"][k];
    frame = std::fmax(frame, cases.table["largest_frame_over_mean_force"][k]);
  }
  study.facts.add("published.increments_ended_least", ended);
  if (irregular == 0) return;
  study.facts.add("published.T_reached_least", reached);
  study.facts.add("published.T_direct_share", found / tried);
  study.facts.add("published.T_frame_over_mean_force_most", frame);
  draw_steps(study, steps);
}

}  // namespace verification
