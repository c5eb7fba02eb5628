#include "choose/choices.hpp"

#include "app/cpu_time.hpp"
#include "app/packing_source.hpp"
#include "app/scratch.hpp"
#include "app/state_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace verification {
namespace {

constexpr std::array increments{2e-3, 1e-3, 5e-4, 2e-4, 1e-4};
constexpr std::array tolerances{1e-2, 1e-3, 1e-4};
constexpr std::array viscous_numbers{0.0, 1e-3};
constexpr double fine_increment = 2.5e-5;
constexpr double fine_tolerance = 1e-9;
// A reference that differs by this at first tells how far equilibria lie apart that no solver can choose
// between.
constexpr double nudge = 1e-6;
constexpr int looks = 5;  // along each path

// Axes of compression in the plane of the first and the last direction [rad].
constexpr std::size_t axes = 6;
double axis_of(std::size_t number) { return M_PI * static_cast<double>(number) / axes; }

// Compression along an axis at constant volume.
template <int D>
TensorOf<D> deformation(double axis, double strain) {
  const double lateral = std::pow(1 - strain, -1.0 / (D - 1));
  Eigen::Matrix<double, D, 1> direction = Eigen::Matrix<double, D, 1>::Zero();
  direction(0) = std::sin(axis);
  direction(D - 1) = std::cos(axis);
  return lateral * TensorOf<D>::Identity() +
         (1 - strain - lateral) * direction * direction.transpose();
}

template <int D>
struct Led {
  std::vector<TensorOf<D>> stress;  // at the looks
  double seconds = 0;
};

template <int D>
Led<D> lead(const Material& material, double axis, double strain, double increment, double off,
            unsigned want) {
  Led<D> result;
  State state(material);
  const long per_look = std::lround(strain / looks / increment);
  const double begin = cpu_seconds();
  for (long step = 1; step <= looks * per_look; ++step) {
    const double share = static_cast<double>(step) / static_cast<double>(looks * per_look);
    TensorOf<D> F = deformation<D>(axis, strain * share);
    if (step == 1) F(0, 0) += off;
    const auto found = evaluate_of<D>(state, F, want);
    if (found.status != GRAINLAW_OK) break;
    state.commit();
    if (step % per_look == 0) result.stress.push_back(found.stress);
  }
  result.seconds = cpu_seconds() - begin;
  return result;
}

// Distances of stresses from those of a path, over the largest of that path.
template <int D>
void add_distances(const std::vector<TensorOf<D>>& stress, const std::vector<TensorOf<D>>& path,
                   std::vector<double>& distances) {
  double largest = 0;
  for (const auto& P : path) largest = std::max(largest, P.norm());
  for (std::size_t k = 0; k < path.size(); ++k)
    distances.push_back((stress[k] - path[k]).norm() / largest);
}

double median(std::vector<double>& numbers) {
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

template <int D>
struct Reference {
  std::array<std::vector<TensorOf<D>>, axes> stress;
  double spread = 0;  // as an error
  double seconds = 0;
};

template <int D>
class TrialOf {
 public:
  TrialOf(MaterialSource source, double strain, const std::function<void(double)>& done)
      : source_(std::move(source)), strain_(strain), done_(done) {
    // A whole number of increments from look to look.
    const double part = strain / looks;
    for (const double increment : increments)
      if (increment <= part) increments_.push_back(part / std::round(part / increment));
  }

  Trial run() {
    Trial trial;
    trial.axes = axes;
    trial.strain = strain_;
    trial.reference = {fine_increment, fine_tolerance, 0};
    const Reference<D> reference = lead_reference();
    trial.spread = reference.spread;
    trial.seconds = reference.seconds;
    for (const double number : viscous_numbers)
      for (const double tolerance : tolerances)
        for (const double increment : increments_)
          trial.tried.push_back(measure({increment, tolerance, number}, reference));
    return trial;
  }

 private:
  Material with(const Choice& choice) const {
    MaterialSource source = source_;
    if (!source.changes.contains("solver")) source.changes.insert("solver", toml::table{});
    toml::table& solver = *source.changes["solver"].as_table();
    for (const char* key : {"viscous_number", "viscous_rate", "viscous_steps"}) solver.erase(key);
    solver.insert_or_assign("tolerance", choice.tolerance);
    if (choice.viscous_number > 0) solver.insert_or_assign("viscous_number", choice.viscous_number);
    return make_material(source, D);
  }

  // Reports work in units of increments.
  void count(double increment) {
    worked_ += 1 / increment;
    double all = axes * 2 / fine_increment;
    for (const double each : increments_)
      all += axes * viscous_numbers.size() * tolerances.size() / each;
    done_(worked_ / all);
  }

  Reference<D> lead_reference() {
    const Material material = with({fine_increment, fine_tolerance, 0});
    Reference<D> result;
    std::vector<double> distances;
    for (std::size_t w = 0; w < axes; ++w) {
      auto& path = result.stress[w];
      Led<D> led = lead<D>(material, axis_of(w), strain_, fine_increment, 0, 0);
      result.seconds += led.seconds / static_cast<double>(axes);
      path = std::move(led.stress);
      count(fine_increment);
      auto beside = lead<D>(material, axis_of(w), strain_, fine_increment, nudge, 0).stress;
      count(fine_increment);
      // A packing that loses its contacts on the way is followed as far as it came.
      path.resize(std::min(path.size(), beside.size()));
      if (path.empty())
        throw ComputationError(fmt::format(
            "the reference, in increments of {:g}, does not reach a strain of {:g}: choose a "
            "smaller --strain",
            fine_increment, strain_ / looks));
      add_distances<D>(beside, path, distances);
    }
    result.spread = median(distances);
    if (!std::isfinite(result.spread))
      throw ComputationError("the packing carries no stress along the paths of the trial");
    return result;
  }

  Tried measure(const Choice& choice, const Reference<D>& reference) {
    const Material material = with(choice);
    Tried tried{choice, {}, {}, 0};
    std::vector<double> errors;
    bool whole = true;
    for (std::size_t w = 0; w < axes; ++w) {
      const Led<D> led =
          lead<D>(material, axis_of(w), strain_, choice.increment, 0, GRAINLAW_WANT_TANGENT_EXACT);
      tried.seconds += led.seconds / static_cast<double>(axes);
      count(choice.increment);
      whole = whole && led.stress.size() >= reference.stress[w].size();
      if (whole) add_distances<D>(led.stress, reference.stress[w], errors);
    }
    if (!whole) return tried;
    tried.error = median(errors);
    tried.largest = *std::max_element(errors.begin(), errors.end());
    return tried;
  }

  MaterialSource source_;
  double strain_;
  std::vector<double> increments_;
  const std::function<void(double)>& done_;
  double worked_ = 0;
};

}  // namespace

Trial try_choices(const MaterialSource& material, double strain,
                  const std::function<void(double)>& done) {
  const int dimension = dimension_of(material);
  const ScratchDirectory scratch;
  // The packing is made once.
  const Material as_it_is = make_material(material, dimension);
  const State state(as_it_is);
  write_packing(state.get(), scratch / "packing");
  const MaterialSource source = with_packing(material, scratch / "packing");
  return dimension == 2 ? TrialOf<2>(source, strain, done).run()
                        : TrialOf<3>(source, strain, done).run();
}

std::vector<Tried> best_choices(const Trial& trial) {
  std::vector<Tried> sorted;
  for (const Tried& tried : trial.tried)
    if (tried.error) sorted.push_back(tried);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Tried& a, const Tried& b) { return a.seconds < b.seconds; });
  std::vector<Tried> best;
  for (const Tried& tried : sorted)
    if (best.empty() || *tried.error < *best.back().error) best.push_back(tried);
  return best;
}

}  // namespace verification
