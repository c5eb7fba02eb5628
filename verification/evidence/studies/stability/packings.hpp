// The packings of the stability study: generated once per recipe, or with a closed form, as CSV
// files in the output directory, and materials made of them.
#pragma once

#include "app/material.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace verification::stability {

struct Disc {
  double x = 0, y = 0, radius = 0;
};

// Particles and cell; the library finds the contacts.
struct TinyPacking {
  std::vector<Disc> discs;
  Tensor cell = Tensor::Identity();  // lattice vectors as columns
  double thickness = 0.1;
};

struct Contact {
  double young = 6e8;        // kn = young 2 Ri Rj / (Ri + Rj) [Pa]
  double ratio = 0.8;        // kt / kn [-]
  double friction = 0.5463;  // [-]
  bool rotation = true;
  double tolerance = 1e-6;   // of the equilibria [-]
  bool stress_free = false;  // without contacts: P = 0, not an error
};

// A periodic packing of mean radius 5 mm, uniform radii, at rest without friction: at 100 kPa up to
// a stiffness of 1000, at less beyond.
struct Recipe {
  double stiffness = 300;       // kn / (p t) of the mean disc, kn / (p R) of the mean sphere [-]
  double size_ratio = 7.0 / 3;  // largest / smallest radius [-]
  int count = 100;
  long seed = 1;
  int dimension = 2;

  [[nodiscard]] double young() const;  // [Pa]
};

// Lengths times `length`, moduli times `modulus`; forces follow.
struct Units {
  double length = 1;
  double modulus = 1;
};

class PackingStore {
 public:
  // viscous_number: solver.viscous_number of the materials; 0: equilibria.
  explicit PackingStore(std::filesystem::path directory, double viscous_number = 0)
      : directory_(std::move(directory)), viscous_number_(viscous_number) {}

  // From the packing's files, which are made when they are missing. `contact.young` is the recipe's.
  [[nodiscard]] Material generated(const Recipe& recipe, Contact contact) const;
  // Adds to generated() a disc in the middle of the widest void, which touches nothing.
  [[nodiscard]] Material with_rattler(const Recipe& recipe, Contact contact) const;
  // Expands generated() until contacts are lost: the last equilibrium before that, at its own F = I.
  [[nodiscard]] Material barely_touching(const Recipe& recipe, Contact contact) const;
  // Writes generated() in other units.
  [[nodiscard]] Material in_units(const Recipe& recipe, Contact contact, const Units& units) const;
  [[nodiscard]] Material tiny(const std::string& name, const TinyPacking& packing,
                              const Contact& contact) const;
  // Spheres of 5 mm radius on a face-centred lattice, `overlap` [m] at F = I.
  [[nodiscard]] Material fcc(double overlap, const Contact& contact) const;

 private:
  // Name of the files of the recipe, made when they are missing.
  [[nodiscard]] std::string ensure(const Recipe& recipe) const;
  [[nodiscard]] static Material make(const Recipe& recipe);
  [[nodiscard]] Material from_files(const std::string& name, const Contact& contact,
                                    bool with_forces, int dimension = 2) const;
  [[nodiscard]] Material made(MaterialSource source, int dimension) const;

  std::filesystem::path directory_;
  double viscous_number_;
};

}  // namespace verification::stability
