// Figures 12 to 14: initial anisotropy, released by the isotropic stress or kept by a deviatoric one.

#include "evidence/papers/liu2019_biaxial/biaxial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace verification {
namespace {

struct Packing {
  const char* name;
  const char* title;
  std::size_t start;  // row of the history at which compression begins
  const char* colour;
  Stroke stroke;
};
constexpr std::size_t released = 10;  // increments of isotropic compression
constexpr Packing packings[]{
    {"isotropic", "isotropic", released, colour::black, Stroke::solid},
    {"released_005", "0.05 across, released", released, colour::amber, Stroke::dashed},
    {"released_008", "0.08 across, released", released, colour::orange, Stroke::dashed},
    {"across_005", "0.05 across, kept", 0, colour::amber, Stroke::solid},
    {"across_008", "0.08 across, kept", 0, colour::orange, Stroke::solid},
    {"along_005", "0.05 along, kept", 0, colour::sky, Stroke::solid},
    {"along_008", "0.08 along, kept", 0, colour::blue, Stroke::solid}};

// Lateral over axial pressure can be larger at the start: the ratio with its sign.
std::vector<double> signed_ratio(const CsvTable& history, std::size_t from) {
  std::vector<double> ratio;
  for (std::size_t k = from; k < history.rows(); ++k) {
    const double s1 = history["sigma11"][k], s2 = history["sigma22"][k];
    ratio.push_back((s2 - s1) / (s1 + s2));
  }
  return ratio;
}

std::vector<double> tail(const CsvTable& history, const char* column, std::size_t from) {
  return {history[column].begin() + static_cast<std::ptrdiff_t>(from), history[column].end()};
}

}  // namespace

void study_initial_anisotropy(PaperStudy& study) {
  Table table("Initial anisotropy", {"packing", "A_made[-]", "ratio_made[-]", "A_at_start[-]",
                                     "ratio_at_start[-]", "A_at_ratio_0.3[-]", "peak_ratio[-]",
                                     "strain_at_peak[-]", "A_at_peak[-]", "largest_compaction[-]"});
  Panel ratio{"stress ratio [-]", {}, 1.2};
  Panel volume{"volume, J / J of the start - 1 [-]"};
  Panel coordination{"coordination [-]"};
  Panel anisotropy{"anisotropy [-]", {}, 1.2};
  Panel fabric{"anisotropy [-]"};
  std::vector<double> starts, peaks, peaks_at, compactions, coordinations, anisotropies;
  for (const Packing& packing : packings) {
    const auto run = study.run(std::string("anisotropy_") + packing.name);
    const auto test = load_biaxial(study, std::string("anisotropy_") + packing.name, packing.start);
    if (!run || !test) continue;
    const CsvTable& h = run->history;
    const std::vector<double> ratios = signed_ratio(h, packing.start);
    const std::size_t peak =
        static_cast<std::size_t>(std::max_element(ratios.begin(), ratios.end()) - ratios.begin());
    const double compaction = *std::min_element(test->volume.begin(), test->volume.end());
    // On the way up.
    const std::vector<double> up(ratios.begin(),
                                 ratios.begin() + static_cast<std::ptrdiff_t>(peak));
    const std::vector<double> made = signed_ratio(h, 0);
    table.row({packing.title, h["anisotropy"].front(), made.front(), test->anisotropy.front(),
               ratios.front(), interpolate(up, test->anisotropy, 0.3), ratios[peak],
               test->strain[peak], test->anisotropy[peak], compaction});
    if (packing.start == released) {
      study.facts.add(fmt::format("anisotropy.{}.start", packing.name), test->anisotropy.front());
      starts.push_back(test->anisotropy.front());
      peaks.push_back(ratios[peak]);
      peaks_at.push_back(test->strain[peak]);
      compactions.push_back(-compaction);
      coordinations.push_back(interpolate(test->strain, test->coordination, 0.07));
      anisotropies.push_back(interpolate(test->strain, test->anisotropy, 0.07));
    }
    ratio.curves.push_back({packing.title, test->strain, ratios, packing.colour, packing.stroke});
    volume.curves.push_back({"", test->strain, test->volume, packing.colour, packing.stroke});
    coordination.curves.push_back(
        {"", test->strain, test->coordination, packing.colour, packing.stroke});
    anisotropy.curves.push_back(
        {packing.title, test->strain, test->anisotropy, packing.colour, packing.stroke});
    fabric.curves.push_back(
        {packing.title, up, tail(h, "anisotropy", packing.start), packing.colour, packing.stroke});
    fabric.curves.back().y.resize(up.size());
  }
  if (ratio.curves.empty()) return;
  draw({"Fig. 13: initial anisotropy", "axial strain [-]", {ratio, volume}},
       study.results / "figure_13");
  draw({"Fig. 14: initial anisotropy", "axial strain [-]", {anisotropy, coordination}},
       study.results / "figure_14");
  draw({"Anisotropy and stress up to the peak", "(s22 - s11) / (s11 + s22) [-]", {fabric}},
       study.results / "figure_14_stress");
  table.print();
  table.write(study.results / "anisotropy.csv");
  if (peaks.size() < 3) return;
  study.facts.add("anisotropy.start_least_rise", least_rise(starts));
  study.facts.add("anisotropy.peak_largest_rise", largest_rise(peaks));
  study.facts.add("anisotropy.peak_at_largest_rise", largest_rise(peaks_at));
  study.facts.add("anisotropy.compaction_largest_rise", largest_rise(compactions));
  study.facts.add("anisotropy.coordination_first_over_others",
                  coordinations[0] / std::max(coordinations[1], coordinations[2]));
  double ordered = 0;
  for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {1, 2}})
    ordered += (anisotropies[a] - anisotropies[b]) * (peaks[a] - peaks[b]) > 0 ? 1.0 / 3 : 0;
  study.facts.add("anisotropy.pairs_ordered_as_strength", ordered);
}

}  // namespace verification
