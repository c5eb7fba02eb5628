#include "reference/servo.hpp"

#include "packing/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace grainlaw::core {

namespace {

// Boundary corrections alternating with relaxations of the inner particles.
class Servo {
 public:
  Servo(Increment<2>& increment, const PublishedOptions& options, double tolerance,
        ReferenceMemory& memory)
      : increment_(increment),
        problem_(increment.problem()),
        motion_(increment.motion()),
        space_(*problem_.space),
        packing_(*problem_.packing),
        options_(options),
        servo_(space_.options.servo),
        tolerance_(tolerance),
        memory_(memory),
        nodes_(problem_.nodes()) {
    smallest_ = 1e300;
    for (std::size_t q = 0; q < nodes_; ++q) {
      if (space_.boundary[q]) smallest_ = std::min(smallest_, motion_.node_radius()[q]);
    }
    dt_ = options.time_step_ratio *
          std::sqrt(mass_of(smallest_) / problem_.law->largest_stiffness(smallest_, smallest_));
    // The relaxation leaves translations of boundary nodes in place, and rotations that are not
    // free.
    memory.servo.frozen.assign(nodes_, 0);
    for (std::size_t q = 0; q < nodes_; ++q) {
      if (!space_.boundary[q]) continue;
      memory.servo.frozen[q] = space_.boundary[q] == free_rotation
                                   ? fixed_translation<2>
                                   : fixed_translation<2> | fixed_rotation<2>;
    }
  }

  bool run() {
    if (space_.averages()) find_areas();
    predict();
    increment_.keep_neighbours();
    // The boundary criterion is a root of a sum of squares, the relaxation's a maximum. Residuals
    // within tolerance at many particles may sum to boundary forces that no correction removes.
    // Then the relaxation takes no step, and its tolerance is tightened.
    constexpr int stalled = 20;  // corrections without a relaxation step
    constexpr double tighter = 0.3;
    double tolerance = tolerance_;
    int without_step = 0;
    for (int correction = 0; correction <= servo_.max_corrections; ++correction) {
      const long steps = increment_.cost.relaxation_steps;
      if (!relax_published(increment_, tolerance, options_, memory_.servo.frozen, memory_)) {
        return false;
      }
      without_step = increment_.cost.relaxation_steps > steps ? 0 : without_step + 1;
      if (without_step == stalled) {
        tolerance *= tighter;
        without_step = 0;
      }
      memory_.correction.assign(problem_.unknowns(), 0.0);
      const double residual =
          std::sqrt(correct_shared() + correct_averaged() + correct_deformation());
      if (residual <= servo_.tolerance && off_average() <= servo_.tolerance_deformation) {
        return true;
      }
      motion_.move(memory_.correction);
      increment_.advance_history();
      increment_.keep_neighbours();
      ++increment_.cost.servo_corrections;
    }
    return false;
  }

 private:
  [[nodiscard]] double mass_of(double radius) const {
    return particle_mass<2>(packing_.density, radius, packing_.thickness);
  }

  // Force scale of a boundary particle, eq. 37.
  [[nodiscard]] double force_scale(double radius) const {
    return mass_of(radius) * radius / (dt_ * dt_);
  }

  // Displacement per force; gains scale with 1/M.
  [[nodiscard]] double compliance(double radius) const {
    return smallest_ * smallest_ / (radius * radius) /
           problem_.law->largest_stiffness(radius, radius);
  }

  [[nodiscard]] const double* reference() const {
    return space_.bound_to_axes() ? space_.reference.data() : packing_.position.data();
  }

  // Component i of F X: the position without fluctuation.
  [[nodiscard]] double affine_position(std::size_t p, std::size_t i,
                                       const std::array<double, 4>& f) const {
    const auto n = packing_.size();
    const double offset = space_.bound_to_axes() ? space_.offset[i * n + p] : 0;
    return f[2 * i] * reference()[p] + f[2 * i + 1] * reference()[n + p] + offset;
  }

  // Moves boundary particles to F X + n_f (x - F X at the start) (Table 2, 2.1; with n_f = 0 Table
  // 3, 1.1). Rotations are kept instead of the published Q = I, and follow the rotation of F: this
  // makes it objective.
  void predict() {
    const auto n = packing_.size();
    for (const int q : packing_.frame->boundary) {
      const auto p = static_cast<std::size_t>(q);
      for (std::size_t i = 0; i < 2; ++i) {
        const double w =
            motion_.start()[i * n + p] - affine_position(p, i, motion_.start_deformation());
        motion_.coordinate(i, p) =
            affine_position(p, i, motion_.deformation()) + servo_.inheritance * w;
      }
    }
  }

  [[nodiscard]] bool averaged(std::size_t q, std::size_t direction) const {
    const auto& node = space_.average[direction].node;
    return std::binary_search(node.begin(), node.end(), static_cast<std::int32_t>(q));
  }

  // Corrects boundary nodes outside averages (P) by eqs. 32-34. Returns the sum of squares of
  // 1.5.A.
  double correct_shared() {
    const auto r = increment_.residual();
    double sum = 0;
    for (std::size_t q = 0; q < nodes_; ++q) {
      if (!space_.boundary[q]) continue;
      const double radius = motion_.node_radius()[q];
      for (std::size_t k = 0; k < 2; ++k) {
        if ((space_.fixed[q] >> k & 1U) != 0 || averaged(q, k)) continue;
        // The boundary force a balances the contact forces: a+ + a- = -r and du = -g (a+ + a-).
        const double force = r[k * nodes_ + q];
        memory_.correction[k * nodes_ + q] = servo_.gain_force * compliance(radius) * force;
        sum += std::pow(force / force_scale(radius), 2);
      }
      const bool rotated =
          space_.boundary[q] != free_rotation && (space_.fixed[q] & fixed_rotation<2>) == 0;
      if (!problem_.law->rotating() || !rotated) continue;
      const double moment = r[2 * nodes_ + q];
      memory_.correction[2 * nodes_ + q] =
          servo_.gain_moment * compliance(radius) / (radius * radius) * moment;
      sum += std::pow(moment / (force_scale(radius) * radius), 2);
    }
    return sum;
  }

  // P from the reference branches (eq. 23).
  [[nodiscard]] std::array<double, 4> measured_stress() const {
    const auto n = packing_.size();
    const double* x = reference();
    std::array<double, 4> p{};
    const auto& list = increment_.contacts();
    for (std::size_t c = 0; c < list.size(); ++c) {
      const auto i = static_cast<std::size_t>(list.i[c]);
      const auto j = static_cast<std::size_t>(list.j[c]);
      const double branch[2] = {x[j] - x[i], x[n + j] - x[n + i]};
      for (std::size_t k = 0; k < 4; ++k) {
        p[k] -=
            (k < 2 ? list.forces[c].x : list.forces[c].y) * branch[k % 2] / space_.reference_volume;
      }
    }
    return p;
  }

  // Corrects boundary nodes under uniform stress by P A - a, then restores the average (eqs. 35, 36
  // with V F A once). With a found component of F the average's multiplier replaces P, since they
  // differ on a jagged side. Returns the sum of squares of 1.5.B.
  double correct_averaged() {
    if (!space_.averages()) return 0;
    std::array<double, 4> stress{};
    const bool published = !found(0) || !found(1);
    if (published) {
      memory_.servo.raw.resize(increment_.forces().size());
      increment_.sum_forces(memory_.servo.raw);
      stress = measured_stress();
    }
    double sum = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto& average = space_.average[i];
      double* step = memory_.correction.data() + i * nodes_;
      for (const auto node : average.node) {
        const auto q = static_cast<std::size_t>(node);
        const double radius = motion_.node_radius()[q];
        double missing = increment_.residual()[i * nodes_ + q];
        if (!found(i)) {
          missing = stress[2 * i] * area_[q][0] + stress[2 * i + 1] * area_[q][1] +
                    (i == 0 ? memory_.servo.raw[q].x : memory_.servo.raw[q].y);
        }
        sum += std::pow(missing / force_scale(radius), 2);
        step[q] = servo_.gain_force * compliance(radius) * missing;
      }
      return_to_average(i, step);
    }
    return sum;
  }

  [[nodiscard]] bool found(std::size_t direction) const {
    return space_.found[2 * direction] || space_.found[2 * direction + 1];
  }

  // Projects the step onto the average constraint.
  void return_to_average(std::size_t i, double* step) {
    const auto& average = space_.average[i];
    std::array<double, 2> off{};
    for (std::size_t k = 0; k < average.node.size(); ++k) {
      const auto q = static_cast<std::size_t>(average.node[k]);
      const double by = servo_.gain_deformation * fluctuation(q, i) + (found(i) ? step[q] : 0);
      off[0] += average.row[k][0] * by;
      off[1] += average.row[k][1] * by;
    }
    for (std::size_t k = 0; k < average.node.size(); ++k) {
      step[static_cast<std::size_t>(average.node[k])] -=
          average.row[k][0] * off[0] + average.row[k][1] * off[1];
    }
  }

  // Corrects found components of F by the missing stress over the stiffness of all contacts
  // together.
  double correct_deformation() {
    double sum = 0;
    for (std::size_t k = problem_.node_unknowns(); k < problem_.unknowns(); ++k) {
      const double missing = increment_.residual()[k];
      memory_.correction[k] = servo_.gain_force * missing / increment_.masses().of_unknowns()[k];
      sum += std::pow(missing / force_scale(smallest_), 2);
    }
    return sum;
  }

  // Sets A_q t of every node under uniform stress, and one particle of it.
  void find_areas() {
    area_.assign(nodes_, {0, 0});
    particle_.assign(nodes_, 0);
    const auto& frame = *packing_.frame;
    for (std::size_t q = 0; q < frame.boundary.size(); ++q) {
      const auto p = static_cast<std::size_t>(frame.boundary[q]);
      const auto node = static_cast<std::size_t>(space_.node[p]);
      particle_[node] = p;
      for (std::size_t k = 0; k < 2; ++k) area_[node][k] += frame.area[q][k] * packing_.thickness;
    }
  }

  [[nodiscard]] double fluctuation(std::size_t node, std::size_t i) const {
    const auto p = particle_[node];
    return motion_.coordinates()[i * packing_.size() + p] -
           affine_position(p, i, motion_.deformation());
  }

  // F - (1/V) sum x (x) A| over the given components.
  [[nodiscard]] double off_average() const {
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if (space_.found[k]) continue;
      double off = 0;
      for (const auto node : space_.average[k / 2].node) {
        const auto q = static_cast<std::size_t>(node);
        off += area_[q][k % 2] * fluctuation(q, k / 2) / space_.reference_volume;
      }
      sum += off * off;
    }
    return std::sqrt(sum);
  }

  static constexpr char free_rotation = 2;

  Increment<2>& increment_;
  const Problem<2>& problem_;
  Motion<2>& motion_;
  const BoundarySpace<2>& space_;
  const Packing& packing_;
  const PublishedOptions& options_;
  const ServoOptions& servo_;
  double tolerance_;
  ReferenceMemory& memory_;
  std::size_t nodes_;
  double smallest_ = 0;  // smallest radius on the boundary [m]
  double dt_ = 0;        // [s]
  std::vector<std::array<double, 2>>& area_ = memory_.servo.area;
  std::vector<std::size_t>& particle_ = memory_.servo.particle;
};

}  // namespace

bool solve_servo(Increment<2>& increment, const PublishedOptions& options, double tolerance,
                 ReferenceMemory& memory) {
  return Servo(increment, options, tolerance, memory).run();
}

}  // namespace grainlaw::core
