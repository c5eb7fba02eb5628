#include "study/study.hpp"

#include "papers/papers_004.hpp"
#include "papers/waves.hpp"

#include "app/commands.hpp"
#include "app/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
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

Table::Cell::Cell(double number)
    : shown(fmt::format("{:.4g}", number)), full(fmt::format("{:.10g}", number)) {}

Table::Table(std::string title, std::vector<std::string> columns)
    : title_(std::move(title)), columns_(std::move(columns)) {}

void Table::row(const std::vector<Cell>& cells) {
  if (cells.size() != columns_.size()) throw std::logic_error("table: a row of another length");
  rows_.push_back(cells);
}

void Table::print() const {
  std::vector<std::size_t> width;
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    width.push_back(columns_[k].size());
    for (const auto& row : rows_) width[k] = std::max(width[k], row[k].shown.size());
  }
  fmt::print("\n{}\n", title_);
  for (std::size_t k = 0; k < columns_.size(); ++k) fmt::print("  {:>{}}", columns_[k], width[k]);
  fmt::print("\n");
  for (const auto& row : rows_) {
    for (std::size_t k = 0; k < row.size(); ++k) fmt::print("  {:>{}}", row[k].shown, width[k]);
    fmt::print("\n");
  }
}

void Table::write(const std::filesystem::path& path) const {
  std::filesystem::create_directories(path.has_parent_path() ? path.parent_path() : ".");
  std::ofstream stream(path);
  stream << fmt::format("{}\n", fmt::join(columns_, ","));
  for (const auto& row : rows_) {
    std::vector<std::string> fields;
    for (const Cell& cell : row) {
      fields.push_back(cell.full);
      std::replace(fields.back().begin(), fields.back().end(), ',', ';');  // one field it stays
    }
    stream << fmt::format("{}\n", fmt::join(fields, ","));
  }
  stream.close();
  if (!stream) throw ComputationError(fmt::format("{}: cannot be written", path.string()));
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
    probes.push_back({name, clone(step.state), step.record.deformation, strain});
  });
  return probes;
}

void add_study_command(CLI::App& app) {
  CLI::App* study = app.add_subcommand("study", "measure what the project claims");
  study->require_subcommand(1);
  auto options = std::make_shared<StudyOptions>();
  study->add_option("--scenes", options->scenes, "directory with the scenes")
      ->capture_default_str();
  study->add_option("--output", options->output, "directory for the results")
      ->capture_default_str();
  add_drained_study(*study, options);
  add_tangent_study(*study, options);
  add_newton_study(*study, options);
  add_objectivity_study(*study, options);
  add_servo_study(*study, options);
  add_ensemble_study(*study, options);
  add_timing_study(*study, options);
  add_reach_study(*study, options);
  add_start_study(*study, options);
  add_error_study(*study, options);
  add_features_study(*study, options);
  add_batch_study(*study, options);
  add_stability_study(*study, options);
  add_papers_study(*study, options);
  add_waves_study(*study, options);
  add_papers_004_study(*study, options);
}

}  // namespace verification
