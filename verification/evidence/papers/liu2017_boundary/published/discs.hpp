// Discs, relaxation and servo as Liu, Bosco & Suiker (2017) publish them, with their units, gains and
// tolerances: written apart from the library, to see where those lead.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace verification {

using Matrix2 = std::array<double, 4>;  // row by row

// Table 4; gains are dimensionless, of forces times dt^2 / M, of moments times dt^2 / (M R^2), of the
// deformation over R^2.
struct PublishedValues {
  double time_step = 1e-6;  // [s]
  double damping = 0.7;
  double energy_ratio = 1e-3;  // Ek / Ep at rest, for so many steps on end
  int steps_below = 20;
  double force_tolerance = 1e-6;
  double deformation_tolerance = 1e-2;
  double gain_force = 1e2, gain_moment = 2e2;             // of P
  double gain_force_of_t = 1e2, gain_deformation = 2e-5;  // of T
  int max_corrections = 60000;                            // ours: beyond, the servo has not ended
};

// Table 4 with the changes of section 4.2.
PublishedValues values_of_irregular_packings();

enum class Rule { D, P, T };

// Residuals of 1.5 and what they leave.
struct Residuals {
  double force = 0;        // r_a
  double deformation = 0;  // r_F
};

class PublishedDiscs {
 public:
  // The packing of a description at F = I, where it is at rest. Throws core::Error.
  PublishedDiscs(const std::string& description, const std::string& base, double friction);

  // Moves the frame to F X, without rotation under D and P (Table 3, 1.1).
  void lead(Rule rule, const Matrix2& f);
  // To F X and this share of what it was apart from it at the F before (Table 2, 2.1).
  void predict(Rule rule, const Matrix2& f, const Matrix2& before, double inheritance);
  // Eqs. 9 to 12 by the criterion Ek / Ep; false without rest.
  bool relax(Rule rule, const PublishedValues& values);
  // Ends once no force on an inner disc is above this share of the mean contact force.
  bool relax_tightly(Rule rule, double tolerance);
  // Moves the frame by eqs. 32 to 36.
  void correct(Rule rule, const Matrix2& f, const PublishedValues& values);
  [[nodiscard]] Residuals residuals(Rule rule, const Matrix2& f,
                                    const PublishedValues& values) const;
  // The frame moves too: a uniform stress on it and the mean deformation F, all forces to 1e-6 of
  // the mean contact force. False where a contact force of a hundredth is left, or in max_steps.
  bool relax_directly(const Matrix2& f, int max_steps);

  [[nodiscard]] Matrix2 piola() const;                           // eq. 23 [Pa]
  [[nodiscard]] Matrix2 cauchy(const Matrix2& f) const;          // eq. 31 [Pa]
  [[nodiscard]] double off_deformation(const Matrix2& f) const;  // |1/V sum x A - F|
  [[nodiscard]] double unbalanced() const;        // on inner discs over the mean contact force
  [[nodiscard]] double unbalanced_frame() const;  // |P A - a|, largest, over the same
  [[nodiscard]] double mean_force() const;        // of contacts [N]
  [[nodiscard]] double stored(bool whole) const;  // eq. 12, or with the elastic part [J]
  [[nodiscard]] double mean_radius() const;
  [[nodiscard]] double stiffness() const { return kn_; }
  [[nodiscard]] double thickness() const { return thickness_; }
  [[nodiscard]] std::size_t size() const { return radius_.size(); }
  [[nodiscard]] long steps() const { return steps_; }

 private:
  struct Pair {
    std::size_t i, j;
    bool touching;
    double tangential;  // force on j along the normal turned by 90 degrees [N]
    double whole;       // whole tangential displacement [m]
  };

  void find_pairs();
  void update_forces();
  // One explicit step of what is free under a rule.
  void move(Rule rule, double dt, double damping);
  [[nodiscard]] double critical_step() const;
  [[nodiscard]] double kinetic() const;
  // Force that holds a disc of the frame, by its place there [N].
  [[nodiscard]] std::array<double, 2> holding(std::size_t q) const;
  // P A - a [N], and V F A - sum (A . A) x [m3].
  [[nodiscard]] std::array<double, 2> missing_force(std::size_t q, const Matrix2& piola) const;
  [[nodiscard]] std::array<double, 2> missing_deformation(std::size_t q, const Matrix2& off) const;
  [[nodiscard]] Matrix2 off(const Matrix2& f) const;  // F - 1/V sum x A
  // Takes from vectors at the frame what changes the mean deformation: of velocities by mass, and
  // of forces the uniform stress.
  void project(std::array<std::vector<double>, 3>& field, bool forces) const;

  double kn_ = 0, ks_ = 0, friction_ = 0, thickness_ = 0, volume_ = 0;
  std::vector<double> radius_, mass_;
  std::array<std::vector<double>, 3> at_, last_, velocity_, force_;  // x, y, rotation
  std::vector<double> reference_;                                    // X, component-major
  std::vector<std::size_t> frame_;
  std::vector<int> partner_;                 // place in frame_; -1: a corner
  std::vector<std::array<double, 2>> area_;  // A of frame_ [m]
  std::vector<char> on_frame_;
  std::vector<Pair> pairs_;
  std::vector<double> found_at_;  // positions of the last search, component-major
  double skin_ = 0;
  double potential_ = 0;      // eq. 12 at the last forces [J]
  double contact_force_ = 0;  // mean normal one [N]
  long steps_ = 0;
};

}  // namespace verification
