// Why meshes and particles differ in irregular packings without bonds.

#include "evidence/papers/liu2018_waves/waves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace verification {

void study_why_waves_differ(WaveStudy& study) {
  const WaveStudy::Run mesh = study.load("figure_4_10_fe208"), plain = study.load("why_plain_dns"),
                       damped = study.load("why_damped_dns");
  if (!mesh || !plain || !damped) return;
  Figure figure{"Why meshes and particles differ without bonds", "time [ms]", {}};
  for (const char* section : {"displacement_1", "displacement_2"}) {
    Panel panel{fmt::format("u / A at {} mm [-]", figure.panels.empty() ? "30" : "300"), {}, 1.2};
    const auto draw_run = [&](const WaveStudy::Run& run, const char* colour, Stroke stroke,
                              const char* title) {
      if (run)
        panel.curves.push_back(wave_curve(*run, section, 1 / pulse_amplitude, colour, stroke,
                                          figure.panels.empty() ? title : ""));
    };
    draw_run(plain, colour::orange, Stroke::solid, "particles");
    draw_run(study.load("why_quarter_dns"), colour::amber, Stroke::dashed,
             "particles, a quarter as large");
    draw_run(damped, colour::green, Stroke::solid, "particles, agitation damped");
    draw_run(mesh, colour::blue, Stroke::solid, "208 elements");
    figure.panels.push_back(panel);
  }
  Panel energy{"energy / work [-]", {}, 1.2};
  const auto shares = [&](const PaperRun& run, auto value, const char* colour, Stroke stroke,
                          const char* title) {
    Curve curve{title, {}, {}, colour, stroke};
    for (std::size_t k = 0; k < run.steps(); ++k) {
      const double work = run.history["work"][k];
      if (run.history["time"][k] < 0.3e-3 || work <= 0) continue;
      curve.x.push_back(1e3 * run.history["time"][k]);
      curve.y.push_back(value(run, k) / work);
    }
    energy.curves.push_back(curve);
  };
  const auto agitation = [](const PaperRun& run, std::size_t k) {
    return run.history["kinetic"][k] - run.history["coherent"][k];
  };
  const auto coherent = [](const PaperRun& run, std::size_t k) {
    return run.history["coherent"][k];
  };
  shares(*plain, coherent, colour::orange, Stroke::solid, "motion of cross-sections, particles");
  shares(*mesh, coherent, colour::blue, Stroke::solid, "the same, 208 elements");
  shares(*plain, agitation, colour::purple, Stroke::solid, "agitation of particles");
  if (const WaveStudy::Run bonded = study.load("why_bonded_dns"))
    shares(*bonded, agitation, colour::grey, Stroke::dashed, "the same, with bonds");
  figure.panels.push_back(energy);
  draw(figure, study.results / "why");

  Table table("Specimens of figure 4.10 with one thing changed, at the end",
              {"case[-]", "u30_over_A[-]", "u300_over_A[-]", "coherent_over_work[-]",
               "agitation_over_work[-]", "stored_over_work[-]", "dissipated_over_work[-]",
               "particles_to_mesh_30[%]", "particles_to_mesh_300[%]"});
  const auto row = [&](const std::string& name, const WaveStudy::Run& run,
                       const WaveStudy::Run& against) {
    if (!run) return;
    const std::size_t end = run->steps() - 1;
    const auto at = [&](const char* column) { return run->history[column][end]; };
    const double work = at("work");
    std::vector<Table::Cell> cells{name,
                                   at("displacement_1") / pulse_amplitude,
                                   at("displacement_2") / pulse_amplitude,
                                   at("coherent") / work,
                                   (at("kinetic") - at("coherent")) / work,
                                   at("stored") / work,
                                   at("dissipated") / work};
    for (const char* section : {"displacement_1", "displacement_2"})
      cells.push_back(against ? Table::Cell(100 * apart(*against, *run, section))
                              : Table::Cell("-"));
    table.row(cells);
  };
  row("particles", plain, mesh);
  row("particles damped", damped, mesh);
  row("particles half as large", study.load("why_half_dns"), mesh);
  row("particles a quarter as large", study.load("why_quarter_dns"), mesh);
  row("particles with free surfaces", study.load("why_free_dns"), mesh);
  row("208 elements", mesh, std::nullopt);
  const WaveStudy::Run periodic = study.load("why_periodic_fe52");
  row("52 elements", study.load("figure_4_10_fe52"), std::nullopt);
  row("52 elements of frame-p", periodic, std::nullopt);
  const WaveStudy::Run confined = study.load("why_confined_fe52");
  row("particles confined", study.load("why_confined_dns"), confined);
  row("particles confined and damped", study.load("why_confined_damped_dns"), confined);
  row("52 elements confined", confined, std::nullopt);
  row("particles bonded", study.load("why_bonded_dns"), std::nullopt);
  table.print();
  table.write(study.results / "why_table.csv");
}

}  // namespace verification
