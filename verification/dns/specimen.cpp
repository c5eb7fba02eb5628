#include "dns/specimen.hpp"

#include "app/cpu_time.hpp"
#include "app/interrupt.hpp"
#include "app/packing_source.hpp"
#include "app/scratch.hpp"
#include "dns/repeat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <vector>

namespace verification {
namespace {

constexpr std::array<const char*, 4> stress_keys{"P11", "P12", "P21", "P22"};

Tensor piola_of(const grainlaw_state* state, const Tensor& deformation) {
  const std::vector<double> s = measure(state, GRAINLAW_CAUCHY_STRESS);
  const Tensor sigma = to_tensor({s[0], s[1], s[2], s[3]});
  return deformation.determinant() * sigma * deformation.inverse().transpose();
}

}  // namespace

Specimen::Specimen(const SpecimenScene& scene, const std::filesystem::path& stem) : scene_(scene) {
  MaterialSource frame = unfold(scene.material);
  frame.changes.insert_or_assign("boundary", toml::table{{"type", "frame-p"}});
  const std::string prefix = stem.string() + "_specimen";
  const ScratchDirectory scratch;
  const std::string one = (scratch / "frame").string();
  {
    const State state(make_material(frame));
    check(grainlaw_state_write_packing(state.get(), one.c_str()), "writing " + one);
  }
  const FramePacking packing = repeat(read_frame(one), scene.repeat[0], scene.repeat[1]);
  write_frame(packing, prefix);
  end_.particles = static_cast<int>(packing.size());
  end_.boundary = static_cast<int>(packing.boundary.size());
  source_ = with_packing(scene.material, prefix);
  toml::table boundary = scene.sides;
  boundary.insert_or_assign("type", "mixed");
  source_.changes.insert_or_assign("boundary", boundary);
}

// Changes the prescribed stresses: each set needs a material, and the state moves from one to the
// next.
void Specimen::prescribe(const Stresses& stress) {
  if (state_ && stress == prescribed_) return;
  toml::table values;
  for (std::size_t k = 0; k < 4; ++k)
    if (stress[k]) values.insert_or_assign(stress_keys[k], *stress[k]);
  MaterialSource source = source_;
  if (!values.empty()) source.changes["boundary"].as_table()->insert_or_assign("stress", values);
  State state(make_material(source));
  if (state_) state.load(state_->save());
  state_ = std::move(state);
  prescribed_ = stress;
}

// Iterates P = sigma cof F with the found F until F stays.
void Specimen::bring_to_start() {
  constexpr int most = 10;
  constexpr double close = 1e-6;
  Tensor F = Tensor::Identity();
  for (int round = 0; round < most; ++round) {
    Tensor sigma = Tensor::Zero();
    Stresses stress;
    for (std::size_t k = 0; k < 4; ++k)
      sigma(static_cast<int>(k / 2), static_cast<int>(k % 2)) = scene_.start[k].value_or(0);
    const Vector4 wanted = to_vector(F.determinant() * sigma * F.inverse().transpose());
    for (std::size_t k = 0; k < 4; ++k)
      if (scene_.start[k]) stress[k] = wanted(static_cast<Eigen::Index>(k));
    state_.reset();  // each round reloads the packing
    prescribe(stress);
    const Tensor found = deformation_of(state_->get());
    const double change = (found - F).norm();
    F = found;
    if (change < close) break;
  }
}

SpecimenEnd Specimen::run(const Observer& observe, const CutObserver& observe_cut,
                          std::exception_ptr& stopped) {
  const auto clock = std::chrono::steady_clock::now();
  double cpu = cpu_seconds();
  for (const SpecimenSegment& segment : scene_.segments) end_.steps_wanted += segment.steps;
  bring_to_start();
  volume_ = measure_scalar(state_->get(), GRAINLAW_REFERENCE_VOLUME);
  deformation_ = deformation_of(state_->get());
  evaluation_.stress = piola_of(state_->get(), deformation_);
  record_ = make_record(state_->get(), deformation_, evaluation_.stress, evaluation_.report);
  end_.start = record_;
  const auto show = [&] {
    end_.cpu += cpu_seconds() - cpu;
    if (observe) observe(state_->get(), record_);
    cpu = cpu_seconds();
  };
  const auto lead = [&] {
    show();
    for (const SpecimenSegment& segment : scene_.segments) {
      const Tensor F = deformation_, P = evaluation_.stress;
      for (int k = 1; k <= segment.steps; ++k) {
        const int number = record_.step + 1;
        record_.effort = {};
        try {
          step(segment, F, P, static_cast<double>(k - 1) / segment.steps,
               static_cast<double>(k) / segment.steps, number, observe_cut);
        } catch (...) {
          end_.effort.add(record_.effort);
          throw;
        }
        end_.effort.add(record_.effort);
        record_.step = end_.steps = number;
        show();
      }
    }
  };
  try {
    lead();
  } catch (const StepError& error) {
    end_.text = error.what();
  } catch (const Interrupted& stop) {
    stopped = std::current_exception();
    end_.text = fmt::format("{} after step {} of {}", stop.text(), end_.steps, end_.steps_wanted);
  }
  end_.cpu += cpu_seconds() - cpu;
  end_.elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return end_;
}

Specimen::Goal Specimen::goal_at(const SpecimenSegment& segment, const Tensor& deformation,
                                 const Tensor& stress, double fraction) const {
  using Kind = SpecimenTarget::Kind;
  Goal goal{deformation, {}};
  for (std::size_t k = 0; k < 4; ++k) {
    const SpecimenTarget& target = segment.target[k];
    const auto i = static_cast<int>(k / 2), j = static_cast<int>(k % 2);
    const double F = deformation(i, j), P = stress(i, j);
    if (target.kind == Kind::deformation)
      goal.deformation(i, j) = F + fraction * (target.value - F);
    if (target.kind == Kind::stretch)
      goal.deformation(i, j) = F * (1 + fraction * (target.value - 1));
    if (target.kind == Kind::stress) goal.stress[k] = P + fraction * (target.value - P);
    // A constant stress keeps the digits of its prescribed value.
    if (target.kind == Kind::keep_stress) goal.stress[k] = prescribed_[k].value_or(P);
  }
  return goal;
}

void Specimen::step(const SpecimenSegment& segment, const Tensor& deformation, const Tensor& stress,
                    double from, double to, int number, const CutObserver& observe_cut) {
  const auto attempt = [&](double load, double) -> std::optional<Refusal> {
    const Goal goal = goal_at(segment, deformation, stress, load);
    prescribe(goal.stress);
    const Evaluation evaluation = evaluate(*state_, goal.deformation, 0);
    record_.effort.add(evaluation.report);
    if (evaluation.status != GRAINLAW_OK) {
      ++record_.effort.cuts;
      return Refusal{.reason = grainlaw_status_text(evaluation.status),
                     .ratio = evaluation.report.step_ratio,
                     .status = evaluation.status};
    }
    record_.effort.history_advanced += evaluation.report.history_advanced;
    accept(evaluation);
    return {};
  };
  grainlaw_march_options march = grainlaw_march_options_default();
  march.max_cuts = scene_.max_cuts;
  make_step({.from = from,
             .to = to,
             .name = fmt::format("step {} (from F22 = {:.6f})", number, deformation_(1, 1)),
             .options = march,
             .observe_cut = observe_cut},
            attempt);
}

void Specimen::accept(const Evaluation& evaluation) {
  const Tensor F = deformation_of(state_->get());
  const double work =
      record_.external_work +
      0.5 * volume_ * (evaluation_.stress + evaluation.stress).cwiseProduct(F - deformation_).sum();
  const Effort effort = record_.effort;
  const int number = record_.step;
  record_ = make_record(state_->get(), F, evaluation.stress, evaluation.report);
  record_.step = number;
  record_.effort = effort;
  record_.external_work = work;
  state_->commit();
  deformation_ = F;
  evaluation_ = evaluation;
}

}  // namespace verification
