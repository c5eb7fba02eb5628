// A map of a packing within a picture: its particles, its frame or cell, and its force chains.
#pragma once

#include "app/snapshot.hpp"
#include "app/svg.hpp"

#include <array>
#include <string>
#include <vector>

namespace verification {

// How the maps of a picture are drawn, so that they can be compared.
struct MapScale {
  double length = 1;  // pixels per m
  double force = 1;   // pixels of a bar's width per N
  double widest = 1;  // of bars [pixels]
};

class PackingMap {
 public:
  // Discs of a periodic cell fill it, cut at its sides. Spheres are seen along y, the far ones first,
  // with the contacts alone that carry more than the mean.
  explicit PackingMap(const Snapshot& snapshot);

  [[nodiscard]] double width() const { return high_[0] - low_[0]; }  // [m]
  [[nodiscard]] double height() const { return high_[1] - low_[1]; }
  [[nodiscard]] double mean_radius() const;
  [[nodiscard]] double mean_force() const { return mean_force_; }
  [[nodiscard]] bool spheres() const { return spheres_; }

  void draw(Svg& svg, double left, double top, const MapScale& scale) const;

  // Lengths, axes, and what the bars of this map mean.
  [[nodiscard]] std::vector<KeyEntry> key(const MapScale& scale) const;

 private:
  using Point = std::array<double, 2>;
  static constexpr int depths = 5;

  void look_at_discs(const Snapshot& snapshot);
  void look_at_spheres(const Snapshot& snapshot);
  void include(const Point& point, double margin);
  [[nodiscard]] bool visible(const Point& point, double margin) const;
  void draw_particles(Svg& svg, double left, double top, const MapScale& scale) const;
  void draw_bars(Svg& svg, double left, double top, const MapScale& scale) const;

  struct Particle {
    Point centre;
    double radius;
    int kind;  // 0: inner, 1: of the boundary; of spheres how near, from 0
  };
  struct Bar {
    Point from, to;
    double force;
    bool bonded;
    int depth;  // how near, from 0
  };

  bool spheres_;
  double mean_force_ = 0;  // of contacts, without sign [N]
  std::vector<Particle> particles_;
  std::vector<Bar> bars_;
  std::vector<Point> outline_;  // of the frame or of the cell
  bool cut_ = false;            // at the outline
  Point low_{}, high_{};
};

}  // namespace verification
