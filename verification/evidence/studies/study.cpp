#include "evidence/studies/study.hpp"

#include "app/progress.hpp"

#include <fmt/format.h>

#include <utility>

namespace verification {

std::filesystem::path StudyOptions::scene(const std::string& name) const {
  const std::filesystem::path path = std::filesystem::path(scenes) / name;
  if (!std::filesystem::is_regular_file(path))
    throw InputError(
        fmt::format("{}: there is no such file; --scenes names the directory with the "
                    "scenes",
                    path.string()));
  return path;
}

MaterialSource StudyOptions::material(double tolerance, int repeat) const {
  constexpr double young = 6e8;  // as in the file [Pa]
  MaterialSource source;
  source.file = scene("yade400.toml");
  source.base = source.file.parent_path();
  change(source, "solver", "tolerance", tolerance);
  if (repeat > 0) change(source, "contact", "young", young * nudged(repeat));
  return source;
}

bool same_contacts(const grainlaw_report& a, const grainlaw_report& b) {
  return a.contacts == b.contacts && a.sliding == b.sliding &&
         a.status_changes == b.status_changes && a.subincrements == b.subincrements;
}

PointOptions study_options() {
  PointOptions options;
  options.max_cuts = 4;
  options.loose_tolerance = 0.1;
  return options;
}

std::vector<Probe> probe_path(const std::string& name, const Material& material,
                              const Segment& segment, int every) {
  std::vector<Probe> probes;
  Progress progress(name + " path");
  PointDriver driver(material, study_options());
  driver.run(segment, [&](const PointStep& step) {
    progress.update(step.fraction, "");
    if (step.record.step % every != 0) return;
    const double strain =
        name == "shear" ? step.record.deformation(0, 1) : step.record.axial_strain();
    probes.push_back({name, step.state, step.record.deformation, strain});
  });
  return probes;
}

}  // namespace verification
