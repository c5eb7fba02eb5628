// `grainlaw_evidence batch`: many points at once, half of them in a shear band beyond the peak and half
// nearly elastic, as in a localising test; the speed-up by threads, and that they change no bit.

#include "evidence/studies/statistics.hpp"
#include "evidence/studies/study.hpp"

#include "app/bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <ctime>
#include <limits>

namespace verification {
namespace {

constexpr double increment = 1e-3;  // of the axial strain [-]

// Processor time of all threads [ms].
double cpu_of_all() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

// The points, and all that a batch gives back.
struct Batch {
  std::vector<State> states;
  std::vector<grainlaw_state*> handles;
  std::vector<Tensor> deformation, stress;
  std::vector<Tangent> tangent;
  std::vector<grainlaw_status> status;
  std::vector<grainlaw_report> reports;

  void add(State state, const Tensor& target) {
    handles.push_back(state.get());
    states.push_back(std::move(state));
    deformation.push_back(target);
    stress.push_back(Tensor::Zero());
    tangent.push_back(Tangent::Zero());
    status.push_back(GRAINLAW_OK);
    reports.push_back(grainlaw_report_default());
  }

  [[nodiscard]] std::size_t size() const { return states.size(); }

  struct Time {
    double wall = 0;  // [ms]
    double cpu = 0;   // of all threads [ms]
  };

  Time evaluate(int threads) {
    using Clock = std::chrono::steady_clock;
    for (grainlaw_report& report : reports) report = grainlaw_report_default();
    const double cpu = cpu_of_all();
    const auto start = Clock::now();
    const grainlaw_status found = grainlaw_evaluate_batch(
        size(), handles.data(), deformation.front().data(), GRAINLAW_WANT_TANGENT_EXACT,
        stress.front().data(), tangent.front().data(), status.data(), reports.data(), threads);
    const std::chrono::duration<double, std::milli> spent = Clock::now() - start;
    if (found < 0) check(found, "evaluating a batch");
    return {spent.count(), cpu_of_all() - cpu};
  }

  [[nodiscard]] bool same_bits(const Batch& other) const {
    const auto same = [](const auto& a, const auto& b) {
      return std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
    };
    return same(stress, other.stress) && same(tangent, other.tangent) &&
           same(status, other.status) && saved() == other.saved();
  }

 private:
  // The trials, made committed, as bytes.
  [[nodiscard]] std::vector<std::byte> saved() const {
    std::vector<std::byte> all;
    for (std::size_t p = 0; p < size(); ++p) {
      State copy = states[p];
      if (status[p] == GRAINLAW_OK) copy.commit();
      const std::vector<std::byte> bytes = copy.save();
      all.insert(all.end(), bytes.begin(), bytes.end());
    }
    return all;
  }
};

// Every second point is the next step of the band's path beyond the peak, the others leave F = I.
Batch make_batch(const Material& material, const std::vector<Probe>& band, int points) {
  Batch batch;
  for (int p = 0; p < points; ++p) {
    const auto half = static_cast<std::size_t>(p / 2);
    if (p % 2 == 0) {
      const Probe& probe = band[band.size() - 1 - half % band.size()];
      batch.add(probe.state, probe.deformation);
    } else {
      const double strain = 0.1 * increment * (1 + static_cast<double>(half % 4));
      batch.add(State(material), Tensor{{1 + 0.4 * strain, 0}, {0, 1 - strain}});
    }
  }
  return batch;
}

struct Arguments {
  int points = 64;
  int threads = 2;
  int rounds = 7;
  double tolerance = 1e-6;
};

void run_study(const StudyOptions& options, const Arguments& arguments) {
  const auto [points, threads, rounds, tolerance] = arguments;
  constexpr int before_peak = 15;  // increments
  const Material material = make_material(options.material(tolerance));
  const int steps = before_peak + (points + 1) / 2;
  std::vector<Probe> band = probe_path(
      "drained", material, drained_segment(-increment * steps, drained_pressure, steps), 1);
  band.erase(band.begin(),
             band.begin() + std::min<std::ptrdiff_t>(before_peak, std::ssize(band) - 1));

  Batch one = make_batch(material, band, points);
  Batch many = make_batch(material, band, points);
  std::vector<double> alone, together, cpu_alone, cpu_together;
  double unordered = std::numeric_limits<double>::quiet_NaN();
  for (int round = 0; round <= rounds; ++round) {
    const Batch::Time single = one.evaluate(1);
    const Batch::Time shared = many.evaluate(threads);
    if (round == 0) {  // the cost of the points is not known yet
      unordered = single.wall / shared.wall;
      continue;
    }
    alone.push_back(single.wall);
    together.push_back(shared.wall);
    cpu_alone.push_back(single.cpu);
    cpu_together.push_back(shared.cpu);
  }
  const bool same = one.same_bits(many);
  double cost = 0, dearest = 0;
  int failed = 0;
  for (std::size_t p = 0; p < one.size(); ++p) {
    const auto steps_taken = static_cast<double>(one.reports[p].relaxation_steps);
    cost += steps_taken;
    dearest = std::max(dearest, steps_taken);
    failed += one.status[p] == GRAINLAW_OK ? 0 : 1;
  }
  const double fastest = *std::ranges::min_element(alone);
  const double fastest_together = *std::ranges::min_element(together);
  Table table(fmt::format("{} points with the exact tangent, half beyond the peak, half nearly "
                          "elastic, tolerance {:.0e} [-]; the best of {} rounds",
                          points, tolerance, rounds),
              {"threads[-]", "one_thread[ms]", "threads[ms]", "speed_up[-]", "speed_up_median[-]",
               "speed_up_first_round[-]", "one_thread_cpu[ms]", "threads_cpu[ms]",
               "dearest_over_mean[-]", "failed[-]", "same_bits[-]"});
  table.row({static_cast<double>(threads), fastest, fastest_together, fastest / fastest_together,
             median(alone) / median(together), unordered, *std::ranges::min_element(cpu_alone),
             *std::ranges::min_element(cpu_together), dearest * points / cost,
             static_cast<double>(failed), same ? 1.0 : 0.0});
  table.print();
  table.write(std::filesystem::path(options.output) / "study_batch.csv");
  if (!same) throw ComputationError("batch: the number of threads changed the results");
}

}  // namespace

void add_batch_study(CLI::App& study, const std::shared_ptr<StudyOptions>& options) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = study.add_subcommand("batch", "speed-up of a batch by threads");
  command->add_option("--points", arguments->points, "integration points [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command->add_option("--threads", arguments->threads, "against one [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command->add_option("--rounds", arguments->rounds, "of which the fastest counts [-]")
      ->check(at_least(1))
      ->capture_default_str();
  command->add_option("--tolerance", arguments->tolerance, "of the equilibria [-]")
      ->capture_default_str();
  command->callback([arguments, options] { run_study(*options, *arguments); });
}

}  // namespace verification
