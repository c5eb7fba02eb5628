// Losses of an increment: energy by friction, drag and broken bonds, and the number of bonds.
#pragma once

namespace grainlaw::core {

class Losses {
 public:
  void begin() { *this = {}; }
  // Adds the work of friction [J].
  void dissipate(double energy) { dissipated_ += energy; }
  // Adds the work of drag [J].
  void drag(double energy) { dragged_ += energy; }
  // Begins a break of bonds at this energy [J]: potential energy with the work of drag so far, which
  // takes up a part of what bonds set free. Until end_break() its decrease is lost, by friction too.
  void begin_break(double energy) {
    after_break_ = true;
    break_energy_ = energy;
    break_dissipated_ = dissipated_;
  }
  void break_bond(double weight) { broken_bonds_ += weight; }
  [[nodiscard]] bool after_break() const { return after_break_; }
  void fall_to(double energy) { dissipated_ = break_dissipated_ + break_energy_ - energy; }
  void end_break() { after_break_ = false; }

  [[nodiscard]] double dissipated() const { return dissipated_; }      // [J]
  [[nodiscard]] double dragged() const { return dragged_; }            // [J]
  [[nodiscard]] double broken_bonds() const { return broken_bonds_; }  // weighted [-]

 private:
  double dissipated_ = 0, dragged_ = 0, broken_bonds_ = 0;
  bool after_break_ = false;
  double break_energy_ = 0, break_dissipated_ = 0;
};

}  // namespace grainlaw::core
