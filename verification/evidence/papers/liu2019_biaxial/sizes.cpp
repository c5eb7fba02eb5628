// How specimens of growing size differ from the endless one of the mesh, before the peak.

#include "evidence/papers/liu2019_biaxial/biaxial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace verification {
namespace {

constexpr double strain_step = 0.0025;
constexpr double until = 0.0225;  // well before every peak
struct Specimen {
  const char* name;
  const char* title;
  double frames;  // across its width
  const char* colour;
};
constexpr std::array<Specimen, 3> specimens{{{"a", "A, 1 frame across", 1, colour::orange},
                                             {"b", "B, 2 frames across", 2, colour::green},
                                             {"c", "C, 3 frames across", 3, colour::purple}}};

// Differences from the mesh as sides over volume would make them, amplitude / frames: the amplitude
// by least squares over the specimens, and what is left.
struct Law {
  double amplitude = 0;
  double rest = 0;  // root mean square [-]
};

Law fit(const std::array<double, 3>& differences) {
  Law law;
  double weight = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    law.amplitude += differences[k] / specimens[k].frames;
    weight += 1 / (specimens[k].frames * specimens[k].frames);
  }
  law.amplitude /= weight;
  for (std::size_t k = 0; k < 3; ++k)
    law.rest += std::pow(differences[k] - law.amplitude / specimens[k].frames, 2) / 3;
  law.rest = std::sqrt(law.rest);
  return law;
}

}  // namespace

void compare_sizes(PaperStudy& study) {
  Table table("Specimens A, B, C of 1, 2, 3 frames across against the mesh, to strain 0.0225",
              {"packing", "rms_A-mesh[-]", "rms_B-mesh[-]", "rms_C-mesh[-]", "B/A[-]", "C/A[-]",
               "rms_from_the_law[-]"});
  Table strains("Mean over the packings", {"strain[-]", "packings[-]", "A-mesh[-]", "B-mesh[-]",
                                           "C-mesh[-]", "sd_A[-]", "sd_B[-]", "sd_C[-]"});
  std::vector<std::array<std::vector<double>, 3>> packings;  // differences by strain
  std::vector<double> at;
  for (double strain = strain_step; strain <= until + 1e-9; strain += strain_step)
    at.push_back(strain);
  std::array<double, 3> all{};  // mean squares over the packings
  double rest_of_all = 0;
  for (int packing = 1; packing <= 5; ++packing) {
    const std::string stem = fmt::format("dns_packings_{}_", packing);
    const auto mesh = load_biaxial(study, stem + "rve");
    std::array<std::vector<double>, 3> differences;
    std::array<double, 3> rms{};
    bool complete = mesh.has_value();
    for (std::size_t k = 0; k < 3 && complete; ++k) {
      const auto run = load_biaxial(study, stem + specimens[k].name);
      complete = run.has_value();
      if (!complete) break;
      for (const double strain : at) {
        differences[k].push_back(run->ratio_at(strain) - mesh->ratio_at(strain));
        rms[k] += differences[k].back() * differences[k].back() / static_cast<double>(at.size());
      }
      rms[k] = std::sqrt(rms[k]);
    }
    if (!complete) continue;
    double rest = 0;
    for (std::size_t s = 0; s < at.size(); ++s)
      rest += std::pow(fit({differences[0][s], differences[1][s], differences[2][s]}).rest, 2);
    rest = std::sqrt(rest / static_cast<double>(at.size()));
    table.row({fmt::format("packing {}", packing), rms[0], rms[1], rms[2], rms[1] / rms[0],
               rms[2] / rms[0], rest});
    for (std::size_t k = 0; k < 3; ++k) all[k] += rms[k] * rms[k];
    rest_of_all += rest * rest;
    packings.push_back(differences);
  }
  if (packings.empty()) return;
  study.facts.add("sizes.b_over_a", std::sqrt(all[1] / all[0]));
  study.facts.add("sizes.c_over_a", std::sqrt(all[2] / all[0]));
  const auto count = static_cast<double>(packings.size());
  std::array<std::vector<double>, 3> means;
  for (std::size_t s = 0; s < at.size(); ++s) {
    std::array<double, 3> mean{}, deviation{};
    for (std::size_t k = 0; k < 3; ++k) {
      for (const auto& one : packings) mean[k] += one[k][s] / count;
      for (const auto& one : packings) deviation[k] += std::pow(one[k][s] - mean[k], 2);
      deviation[k] = count > 1 ? std::sqrt(deviation[k] / (count - 1)) : 0;
      means[k].push_back(mean[k]);
    }
    strains.row(
        {at[s], count, mean[0], mean[1], mean[2], deviation[0], deviation[1], deviation[2]});
  }
  for (double& square : all) square = std::sqrt(square / count);
  table.row({"all", all[0], all[1], all[2], all[1] / all[0], all[2] / all[0],
             std::sqrt(rest_of_all / count)});
  table.print();
  table.write(study.results / "sizes.csv");
  strains.print();
  strains.write(study.results / "sizes_means.csv");
  Panel single{"specimen - mesh [-]"};
  Panel scaled{"mean, times frames across [-]"};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t p = 0; p < packings.size(); ++p)
      single.curves.push_back({"", at, packings[p][k], specimens[k].colour, Stroke::thin});
    single.curves.push_back({"", at, means[k], specimens[k].colour});
    std::vector<double> times = means[k];
    for (double& value : times) value *= specimens[k].frames;
    scaled.curves.push_back({specimens[k].title, at, times, specimens[k].colour});
  }
  draw({"Stress ratio: specimens against the endless one", "axial strain [-]", {single, scaled}},
       study.results / "sizes");
}

}  // namespace verification
