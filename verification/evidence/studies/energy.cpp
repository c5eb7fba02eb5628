// `grainlaw_evidence energy`: how well energy is balanced with drag, law by law and increment by
// increment: work on the packing = stored + friction and broken bonds + drag.

#include "evidence/studies/study.hpp"

#include "app/bounds.hpp"
#include "app/jobs.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace verification {
namespace {

constexpr double load_step = 1e-3;  // coarsest increment [-]
constexpr std::array<int, 4> parts_of_step{1, 2, 4, 8};

struct Law {
  const char* name;
  std::function<void(MaterialSource&)> apply;
};

std::vector<Law> laws() {
  const auto table = [](MaterialSource& source, toml::table contact) {
    source = unfold(source);
    source.changes.insert_or_assign("contact", std::move(contact));
  };
  const toml::table linear{
      {"law", "frictional"}, {"young", 6e8}, {"ratio", 0.8}, {"friction", std::tan(0.5)}};
  const auto with_bonds = [=](MaterialSource& source, double strength) {
    toml::table contact = linear;
    contact.insert_or_assign("law", "bonded");
    contact.insert("bond", toml::table{{"normal_strength", strength},
                                       {"tangential_strength", strength},
                                       {"bending_stiffness", 20.0},
                                       {"bending_strength", 2e-3 * strength}});
    table(source, contact);
  };
  return {{"compressive",
           [=](MaterialSource& source) {
             table(source, toml::table{{"law", "compressive"}, {"young", 6e8}});
           }},
          {"frictional", [=](MaterialSource& source) { table(source, linear); }},
          {"rolling resistance",
           [=](MaterialSource& source) {
             toml::table contact = linear;
             contact.insert("rolling", toml::table{{"ratio", 1.0}, {"friction", 0.1}});
             table(source, contact);
           }},
          {"Hertz-Mindlin",
           [=](MaterialSource& source) {
             table(source, toml::table{{"law", "hertz"},
                                       {"shear_modulus", 9e9},
                                       {"poisson", 0.2},
                                       {"friction", std::tan(0.5)}});
           }},
          {"bonds that hold", [=](MaterialSource& source) { with_bonds(source, 1e6); }},
          {"bonds that break", [=](MaterialSource& source) { with_bonds(source, 200); }}};
}

// Energies of a path, over what work was done either way.
struct Ledger {
  double worked = 0;  // sum of |work| [J]
  double work = 0, stored = 0, dissipated = 0, dragged = 0;
  std::string failure;
  [[nodiscard]] double remainder() const { return (work - stored - dissipated - dragged) / worked; }
};

class Walker {
 public:
  explicit Walker(const Material& material)
      : state_(material), volume_(measure_scalar(state_.get(), GRAINLAW_REFERENCE_VOLUME)) {
    stress_ = evaluate(state_, here_, 0).stress;
    pressure_ = -stress_(0, 0);
    stored_ = measure_scalar(state_.get(), GRAINLAW_ELASTIC_ENERGY);
  }

  // Commits F; false where there is no answer.
  bool go(const Tensor& to) {
    const Evaluation at = evaluate(state_, to, 0);
    if (at.status != GRAINLAW_OK) return false;
    const double work = 0.5 * volume_ * (stress_ + at.stress).cwiseProduct(to - here_).sum();
    ledger_.work += work;
    ledger_.worked += std::abs(work);
    ledger_.dragged += at.report.viscous_work;
    state_.commit();
    here_ = to;
    stress_ = at.stress;
    return true;
  }

  // F11 such that P11 stays.
  bool compress(double axial) {
    constexpr int most_iterations = 20;
    Tensor next = here_;
    next(1, 1) = 1 - axial;
    for (int k = 0; k < most_iterations; ++k) {
      const Evaluation at = evaluate(state_, next, GRAINLAW_WANT_TANGENT_EXACT);
      if (at.status != GRAINLAW_OK) return false;
      const double missing = at.stress(0, 0) + pressure_;
      if (std::abs(missing) < 1e-8 * pressure_) return go(next);
      next(0, 0) -= missing / at.tangent(0, 0);
    }
    return false;
  }

  Ledger ledger() {
    ledger_.stored = measure_scalar(state_.get(), GRAINLAW_ELASTIC_ENERGY) - stored_;
    ledger_.dissipated = measure_scalar(state_.get(), GRAINLAW_DISSIPATED_ENERGY);
    return ledger_;
  }

 private:
  State state_;
  double volume_;
  Tensor here_ = Tensor::Identity(), stress_;
  double pressure_ = 0, stored_ = 0;
  Ledger ledger_;
};

struct Run {
  std::size_t law;
  bool cycle;
  int parts;
  Ledger ledger;
};

void walk(const StudyOptions& options, Run& run, double number, int count) {
  constexpr double drained_to = 0.03, shear = 5e-3;
  MaterialSource source;
  source.file = options.scene("pack400.toml");
  source.base = source.file.parent_path();
  laws()[run.law].apply(source);
  change(source, "packing", "count", static_cast<long>(count));
  change(source, "solver", "tolerance", 1e-11);
  if (number > 0) change(source, "solver", "viscous_number", number);
  Walker walker(make_material(source));
  const double strain = load_step / run.parts;
  const int way = static_cast<int>(std::lround((run.cycle ? shear : drained_to) / strain));
  bool goes = true;
  for (int n = 1; goes && n <= (run.cycle ? 4 * way : way); ++n) {
    if (!run.cycle) {
      goes = walker.compress(n * strain);
      continue;
    }
    const int at = n <= way ? n : n <= 3 * way ? 2 * way - n : n - 4 * way;
    Tensor F = Tensor::Identity();
    F(0, 1) = at * strain;
    goes = walker.go(F);
  }
  run.ledger = walker.ledger();
  if (!goes) run.ledger.failure = "no answer";
}

void run_study(const StudyOptions& options, double number, int count, int threads) {
  std::vector<Run> runs;
  for (std::size_t law = 0; law < laws().size(); ++law)
    for (const bool cycle : {false, true})
      for (const int parts : parts_of_step) runs.push_back({law, cycle, parts, {}});
  run_jobs(runs.size(), threads, [&](std::size_t k) { walk(options, runs[k], number, count); });
  Table table(fmt::format("energy over the work done, {} discs, viscous_number {:g}; what the "
                          "remainder tends to by its last two",
                          count, number),
              {"law", "path", "increment[-]", "stored[-]", "friction_and_bonds[-]", "drag[-]",
               "remainder[-]", "tends_to[-]"});
  const Run* last = nullptr;
  for (const Run& run : runs) {
    const Ledger& l = run.ledger;
    const bool follows = last && last->law == run.law && last->cycle == run.cycle;
    table.row(
        {laws()[run.law].name, run.cycle ? "cycle" : "drained", load_step / run.parts,
         l.stored / l.worked, l.dissipated / l.worked, l.dragged / l.worked,
         l.failure.empty() ? Table::Cell(l.remainder()) : Table::Cell(l.failure),
         follows ? Table::Cell(2 * l.remainder() - last->ledger.remainder()) : Table::Cell("")});
    last = &run;
  }
  table.print();
  table.write(std::filesystem::path(options.output) / "study_drag_energy.csv");
}

}  // namespace

void add_energy_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  struct Arguments {
    double number = 1e-3;
    int count = 100;
    int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = study.add_subcommand("energy", "balance of energy with drag, by increments");
  command->add_option("--number", arguments->number, "solver.viscous_number; 0: equilibrium [-]")
      ->check(at_least(0))
      ->capture_default_str();
  command->add_option("--count", arguments->count, "discs of the packing [-]")
      ->check(at_least(20))
      ->capture_default_str();
  command->add_option("--threads", arguments->threads, "paths run at once [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command->callback([arguments, options] {
    run_study(*options, arguments->number, arguments->count, arguments->threads);
  });
}

}  // namespace verification
