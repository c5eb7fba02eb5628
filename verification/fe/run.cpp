#include "fe/run.hpp"

#include "app/history.hpp"
#include "app/interrupt.hpp"
#include "app/progress.hpp"
#include "app/text.hpp"
#include "fe/output/run_output.hpp"
#include "point/start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <limits>

#include <sstream>

namespace verification {
namespace {

// Identity of a checkpoint: the mesh, and the scene without keys that do not change results.
struct Identity {
  std::string scene;
  std::string mesh;
};

Identity identity(const SceneFile& file, const Mesh& mesh) {
  toml::table content = file.content;
  for (const char* key : {"threads", "checkpoint_every"}) content.erase(key);
  std::ostringstream scene;
  scene << content;
  CheckpointWriter bytes;
  for (const auto& node : mesh.nodes) bytes.write(node);
  bytes.write(mesh.elements);
  for (const auto& [name, nodes] : mesh.node_sets) {
    bytes.write(name);
    bytes.write(nodes);
  }
  for (const auto& [name, sides] : mesh.side_sets) {
    bytes.write(name);
    bytes.write(sides);
  }
  return {scene.str(), bytes.bytes()};
}

// Throws InputError with the first line that differs.
void check_same_scene(const CheckpointReader& in, const std::string& saved,
                      const std::string& scene) {
  if (saved == scene) return;
  std::istringstream before(saved), now(scene);
  std::string line_before, line_now;
  while (line_before == line_now) {
    if (!std::getline(before, line_before)) line_before = "the end of the scene";
    if (!std::getline(now, line_now)) line_now = "the end of the scene";
  }
  throw InputError(
      fmt::format("{}: was made with another scene: found `{}` now, expected `{}`; start anew "
                  "without --restart",
                  in.path().string(), line_now, line_before));
}

OwnFiles claim(const FiniteElementScene& scene, const SceneFile& file, const RunOptions& options) {
  const std::filesystem::path directory = options.destination.directory;
  const bool goes_on =
      options.restart && std::filesystem::exists(directory / (scene.name + ".checkpoint"));
  std::vector<std::filesystem::path> inputs = files_of(scene.material);
  inputs.push_back(file.path);
  if (const auto mesh = file.content["mesh"]["file"].value<std::string>())
    inputs.push_back(file.path.parent_path() / *mesh);
  return options.destination.claim(outputs_of(scene, goes_on), inputs);
}

class Run {
 public:
  Run(const SceneFile& file, const RunOptions& options)
      : scene_(read_fe_scene(file)),
        identity_(identity(file, scene_.model.mesh)),
        file_(file.path),
        every_(options.checkpoint_every.value_or(scene_.output.checkpoint_every)),
        stop_after_(options.stop_after.value_or(std::numeric_limits<int>::max())),
        directory_(options.destination.directory),
        own_(claim(scene_, file, options)),
        stem_(options.destination.stem(scene_.name)),
        checkpoint_(stem_.string() + ".checkpoint"),
        progress_(scene_.name) {
    const Material material = make_material(
        scene_.prestress.empty() ? scene_.material
                                 : prestressed(scene_.material, scene_.prestress, stem_),
        scene_.dimension);
    start_ = measure_start(State(material).get(), scene_.material);
    print_start(scene_.name, start_);
    if (scene_.cycle) cycle_.emplace(*scene_.cycle, scene_.model, 1.0 / scene_.steps);
    const bool found = std::filesystem::exists(checkpoint_);
    if (options.restart && found) {
      CheckpointReader in = read_checkpoint(checkpoint_);
      check_same_scene(in, in.get<std::string>(), identity_.scene);
      if (in.get<std::string>() != identity_.mesh)
        throw InputError(checkpoint_.string() + ": was made with another mesh");
      list_as_it_is(checkpoint_);
      in.read(done_);
      RunTables tables(stem_, in);
      solver_ = make_solver(scene_.solver, scene_.model, material, scene_.threads);
      solver_->restore(in);
      if (cycle_) cycle_->restore(in);
      output_.emplace(scene_, std::move(tables), *solver_);
      output_->restore(in);
      fmt::print("{}: goes on after step {} of {}\n", scene_.name, done_, scene_.steps);
      std::fflush(stdout);
    } else {
      if (options.restart)
        fmt::print("{}: there is no {}, so this starts from the beginning\n", scene_.name,
                   checkpoint_.string());
      solver_ = make_solver(scene_.solver, scene_.model, material, scene_.threads);
      if (found) std::filesystem::remove(checkpoint_);  // its tables will be overwritten
      output_.emplace(scene_, RunTables(stem_), *solver_);
    }
  }

  void go() {
    const Interrupt interrupt;
    const auto observe = [&](const LoadStep& step, const Solver&) { after(step); };
    solver_->observe_cuts([this](double part, const std::string& reason) {
      ++cuts_;
      progress_.update(static_cast<double>(std::max(done_, 0)) / scene_.steps,
                       describe_cut(done_ + 1, part, reason));
    });
    const int last = std::min(stop_after_, scene_.steps);
    try {
      if (cycle_)
        run_cycles(*cycle_, *solver_, last, observe, done_ + 1);
      else
        run_load_steps(*solver_, scene_.solver.duration(), scene_.steps, last, observe, done_ + 1);
    } catch (const ComputationError& error) {
      const auto* const step = dynamic_cast<const StepError*>(&error);
      if (step != nullptr) ++cuts_;  // cut of the smallest part
      try {
        finish(true);
      } catch (const std::exception&) {  // adds nothing to the reported error
      }
      throw ComputationError(fmt::format("{}: {}{}", file_.string(), error.what(),
                                         advice(step == nullptr ? GRAINLAW_OK : step->status)));
    } catch (const Interrupted&) {
      finish();
      throw;
    }
    finish();
  }

 private:
  // What may help where a step failed.
  [[nodiscard]] std::string advice(grainlaw_status status) const {
    if (scene_.solver.kind == SolverKind::dynamics)
      return why_at_start(start_, done_) + (scene_.solver.dynamics.time_step > 0
                                                ? "; leave out dynamics.time_step, or shorten it"
                                                : "; try a lower dynamics.safety");
    if (done_ < 0)
      return why_at_start(start_, 0) +
             "; look at the loads that act from time 0 on, which load steps do not divide; "
             "pressure "
             "presses where it is above 0";
    return load_advice(start_, done_, status);
  }

  // Ends the output; `failed`: in a step after the last complete one, whose cost counts.
  void finish(bool failed = false) {
    progress_.clear();
    Effort unfinished;
    if (failed) {
      unfinished = solver_->points().effort();
      unfinished.cuts = cuts_;
      output_->add_unfinished(done_ + 1, unfinished);
    }
    output_->finish();
    fmt::print("{}: {}{}\n", scene_.name, output_->summary(unfinished), output_->written());
  }

  void after(const LoadStep& step) {
    done_ = step.record.step;
    cuts_ = 0;
    const bool turned_enough = cycle_ && cycle_->finished();
    const bool last = done_ == scene_.steps || turned_enough;
    output_->add(step, turned_enough && done_ < scene_.steps);
    const int signal = last ? 0 : Interrupt::signal();
    const bool stops = !last && (signal != 0 || done_ >= stop_after_);
    const bool regular = every_ > 0 && (last || (done_ > 0 && done_ % every_ == 0));
    if (stops || regular || (last && std::filesystem::exists(checkpoint_))) save();
    if (stops) {
      progress_.clear();
      fmt::print(
          "{}: ended after step {} of {} as asked; go on with\n  grainlaw solve {} "
          "--output {} --restart\n",
          scene_.name, done_, scene_.steps, shell_text(file_.string()), shell_text(directory_));
    }
    if (signal != 0) throw Interrupted{signal};
    if (!stops)
      progress_.update(static_cast<double>(done_) / scene_.steps,
                       fmt::format("axial strain {1:.2f} %, sigma{0}{0} {2:.1f} kPa",
                                   scene_.dimension, 100 * step.record.axial_strain(),
                                   step.record.cauchy.bottomRightCorner<1, 1>().value() / 1e3));
  }

  void save() {
    const auto measure = solver_->points().cost().measure(Stage::output);
    CheckpointWriter out;
    out.write(identity_.scene);
    out.write(identity_.mesh);
    out.write(done_);
    output_->save_tables(out);
    solver_->save(out);
    if (cycle_) cycle_->save(out);
    output_->save(out);
    write_checkpoint(checkpoint_, out);
  }

  FiniteElementScene scene_;
  Identity identity_;
  std::filesystem::path file_;
  int every_;
  int stop_after_;
  std::string directory_;
  OwnFiles own_;
  std::filesystem::path stem_;
  std::filesystem::path checkpoint_;
  std::unique_ptr<Solver> solver_;
  std::optional<CycleControl> cycle_;
  std::optional<RunOutput> output_;
  Progress progress_;
  PackingStart start_;
  int done_ = -1;  // last complete step
  int cuts_ = 0;   // since then
};

}  // namespace

void run_fe_scene(const SceneFile& file, const RunOptions& options) { Run(file, options).go(); }

}  // namespace verification
