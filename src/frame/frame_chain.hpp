// Chains of near-contacts through a periodic packing, by shortest-path search.
#pragma once

#include "frame/frame_geometry.hpp"
#include "packing/neighbours.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace grainlaw::core {

// An image of a particle, given by its lattice vectors from the cell.
struct Site {
  int particle = 0;
  std::array<int, 2> cell{};
};

struct Chain {
  std::vector<Site> sites;  // from O to its image, both included
  double cost = 0;          // length plus penalties for straying and gaps [m]
};

// The graph of near-contacts of a periodic packing whose positions lie in the cell.
class ChainGraph {
 public:
  // Builds the graph.
  //   position     x[0..n), y[0..n) in the cell [m]
  //   h            2x2 row-major [m]
  //   largest_gap  between neighbours in a chain [m]
  ChainGraph(std::vector<double> position, const std::vector<double>& radius,
             const std::array<double, 4>& h, double largest_gap);

  // The cheapest chain from particle `origin` to its image one lattice vector `direction` (0 or 1)
  // away. It avoids blocked particles and other images of the origin. Returns nothing when there is
  // no chain.
  std::optional<Chain> shortest(int origin, int direction, const std::vector<char>& blocked);

  [[nodiscard]] Point position_of(const Site& site) const;

 private:
  struct Link {
    int to;
    std::array<int, 2> shift;
    double length, gap;
  };
  [[nodiscard]] double off_line(const Point& start, const Point& along, const Point& p) const;

  std::vector<double> position_;
  std::array<double, 4> h_;
  double mean_radius_ = 0;
  std::vector<std::size_t> begin_;  // links of particle p: begin_[p] .. begin_[p + 1]
  std::vector<Link> links_;
  // Workspace of the search per site, reset through touched_.
  std::vector<double> cost_;
  std::vector<std::size_t> from_;
  std::vector<std::size_t> touched_;
};

}  // namespace grainlaw::core
