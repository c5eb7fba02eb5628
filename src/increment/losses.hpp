// What an increment loses on its way: energy by friction and broken bonds, and the bonds.
#pragma once

namespace grainlaw::core {

class Losses {
 public:
  void begin() { *this = {}; }
  // What friction takes [J].
  void dissipate(double energy) { dissipated_ += energy; }
  // What a drag takes [J].
  void drag(double energy) { dragged_ += energy; }
  // Bonds break in a state of this potential energy [J]: until end_break() what it falls by is lost, by
  // friction too.
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
  [[nodiscard]] double broken_bonds() const { return broken_bonds_; }  // with their weights [-]

 private:
  double dissipated_ = 0, dragged_ = 0, broken_bonds_ = 0;
  bool after_break_ = false;
  double break_energy_ = 0, break_dissipated_ = 0;
};

}  // namespace grainlaw::core
