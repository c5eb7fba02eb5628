// Volumes with the inertia of their grains against particles, in irregular packings.

#include "evidence/papers/liu2018_waves/waves.hpp"

#include <fmt/format.h>

namespace verification {
namespace {

constexpr const char* near = "displacement_1";
constexpr const char* far = "displacement_2";

double share_at_end(const PaperRun& run, const char* column) {
  const std::size_t end = run.steps() - 1;
  return run.history[column][end] / run.history["work"][end];
}

double agitation(const PaperRun& run) {
  return share_at_end(run, "kinetic") - share_at_end(run, "coherent");
}

void draw_displacements(const WaveStudy& study) {
  Figure figure{"Volumes with the inertia of their grains", "time [ms]", {}};
  const auto add = [&](const char* title, const char* section, const std::string& particles,
                       const std::string& balanced, const std::string& inertia) {
    Panel panel{title, {}, 1.2};
    const bool first = figure.panels.empty();
    const auto draw_run = [&](const std::string& name, const char* colour, Stroke stroke,
                              const char* of) {
      if (const WaveStudy::Run run = study.load(name))
        panel.curves.push_back(
            wave_curve(*run, section, 1 / pulse_amplitude, colour, stroke, first ? of : ""));
    };
    draw_run(particles, colour::orange, Stroke::solid, "particles");
    draw_run(balanced, colour::blue, Stroke::dashed, "volumes in equilibrium");
    draw_run(inertia, colour::green, Stroke::solid, "volumes with inertia");
    figure.panels.push_back(panel);
  };
  for (const auto& [section, at] : {std::pair{near, "30"}, std::pair{far, "300"}}) {
    add(fmt::format("no bonds, u / A at {} mm [-]", at).c_str(), section, "inertia_loose_dns",
        "figure_4_10_fe208", "inertia_loose_fe208");
    add(fmt::format("bonds, u / A at {} mm [-]", at).c_str(), section, "inertia_bonded_dns",
        "figure_4_8_fe320", "inertia_bonded_fe320");
  }
  draw(figure, study.results / "inertia");
}

}  // namespace

void study_waves_with_inertia(WaveStudy& study) {
  Table table("Volumes with the inertia of their grains, at the end",
              {"case[-]", "elements[-]", "u30_over_A[-]", "u300_over_A[-]", "coherent_over_work[-]",
               "agitation_over_work[-]", "stored_over_work[-]", "lost_over_work[-]",
               "to_particles_30[%]", "to_particles_300[%]"});
  const auto row = [&](const std::string& name, int elements, const PaperRun& run,
                       const WaveStudy::Run& against) {
    const std::size_t end = run.steps() - 1;
    std::vector<Table::Cell> cells{name,
                                   static_cast<double>(elements),
                                   run.history[near][end] / pulse_amplitude,
                                   run.history[far][end] / pulse_amplitude,
                                   share_at_end(run, "coherent"),
                                   agitation(run),
                                   share_at_end(run, "stored"),
                                   share_at_end(run, "dissipated")};
    for (const char* section : {near, far})
      cells.push_back(against ? Table::Cell(100 * apart(run, *against, section))
                              : Table::Cell("-"));
    table.row(cells);
  };
  bool any = false;
  for (const auto& [kind, elements] :
       {std::pair{"loose", 208}, std::pair{"loose_coarse", 52}, std::pair{"loose_fine", 416},
        std::pair{"loose_short", 52}, std::pair{"loose_long", 52}, std::pair{"loose_periodic", 52},
        std::pair{"bonded", 320}, std::pair{"bonded_coarse", 160}}) {
    const std::string name = fmt::format("inertia_{}", kind);
    const WaveStudy::Run particles = study.load(name + "_dns"),
                         mesh = study.load(fmt::format("{}_fe{}", name, elements));
    if (!particles || !mesh) continue;
    any = true;
    const std::string fact = fmt::format("inertia.{}", kind);
    study.facts.add(fact + "_near", apart(*mesh, *particles, near));
    study.facts.add(fact + "_far", apart(*mesh, *particles, far));
    const std::string shown(kind);
    if (shown == "loose" || shown == "bonded") row("particles " + shown, 0, *particles, {});
    row(shown, elements, *mesh, particles);
    if (shown == "loose")
      study.facts.add("inertia.agitation_of_volumes_over_particles",
                      agitation(*mesh) / agitation(*particles));
  }
  if (!any) return;
  table.print();
  table.write(study.results / "inertia_table.csv");
  draw_displacements(study);
}

}  // namespace verification
