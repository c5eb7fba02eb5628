// Points that follow a mesh of p4est which is refined, coarsened and handed to other ranks.
#pragma once

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>
#include <deal.II/distributed/tria.h>

#include <boost/range/iterator_range.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <grainlaw/dealii/points.hpp>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace grainlaw::dealii {

// What a change of the mesh lost, over all ranks.
struct Lost {
  double stress = 0;  // change of the integral of P, over that before [-]
  double energy = 0;  // change of the energy stored in contacts, over that before [-]
  double strain = 0;  // largest distance of the F of a state from I + grad u at its point [-]
};

// Copies to every new point the committed state of the nearest point of its old cell or parent. A cell
// that was coarsened gets those of its children. Of equally near ones the first is taken. One object is
// for one change:
//
//   Refinement<dim> change(points, mesh);   // the mesh has its flags
//   mesh.execute_coarsening_and_refinement();
//   ...                                     // unknowns are distributed again, u is interpolated
//   const Lost lost = change.finish(u);
//
// Calls of all ranks. Where finish() throws, the points are undefined.
template <int dim>
class Refinement {
 public:
  using Mesh = ::dealii::parallel::distributed::Triangulation<dim>;

  // Trials are dropped.
  Refinement(Points<dim>& points, Mesh& mesh)
      : points_(points), mesh_(mesh), per_(points.values_.n_quadrature_points) {
    together(points_.comm_, [&] {
      points_.revert();
      whole_ = integrals();
      places_ = places();
      std::vector<std::size_t> all(points_.set_.size());
      std::iota(all.begin(), all.end(), 0);
      saved_ = points_.set_.save_some(all);
    });
    handle_ = mesh_.register_data_attach(
        [this](const Cell& cell, Status status) { return packed(cell, status); }, true);
  }
  Refinement(const Refinement&) = delete;
  Refinement& operator=(const Refinement&) = delete;

  template <class Vector>
  Lost finish(const Vector& u) {
    saved_ = {};
    together(points_.comm_, [&] {
      points_.fit();
      places_ = places();
      mesh_.notify_ready_to_unpack(handle_,
                                   [this](const Cell& cell, Status status, const Bytes& bytes) {
                                     unpack(cell, status, bytes);
                                   });
    });
    points_.take_answer();
    Lost lost;
    const std::vector<double> before = summed(whole_);
    together(points_.comm_, [&] { whole_ = integrals(); });
    const std::vector<double> after = summed(whole_);
    double change = 0, norm = 0;
    for (std::size_t c = 0; c + 1 < after.size(); ++c) {
      change += std::pow(after[c] - before[c], 2);
      norm += std::pow(before[c], 2);
    }
    lost.stress = norm > 0 ? std::sqrt(change / norm) : 0;
    lost.energy = before.back() > 0 ? std::abs(after.back() - before.back()) / before.back() : 0;
    const Vector all = points_.readable(u);
    together(points_.comm_, [&] { lost.strain = farthest(all); });
    lost.strain = ::dealii::Utilities::MPI::max(lost.strain, points_.comm_);
    return lost;
  }

 private:
  using Cell = typename ::dealii::Triangulation<dim>::cell_iterator;
  using Status = typename ::dealii::Triangulation<dim>::CellStatus;
  using Bytes = ::boost::iterator_range<std::vector<char>::const_iterator>;

  // Numbers of this rank's cells by their place in the mesh.
  [[nodiscard]] std::vector<std::size_t> places() const {
    std::vector<std::size_t> places(mesh_.n_active_cells());
    points_.each_cell(
        [&](const auto& cell, std::size_t k) { places[cell->active_cell_index()] = k; });
    return places;
  }
  [[nodiscard]] std::size_t first_point(const Cell& cell) const {
    return per_ * places_[cell->active_cell_index()];
  }

  [[nodiscard]] std::vector<double> summed(std::vector<double> own) const {
    MPI_Allreduce(MPI_IN_PLACE, own.data(), static_cast<int>(own.size()), MPI_DOUBLE, MPI_SUM,
                  points_.comm_);
    return own;
  }

  // Integrals of P, by its components, and of the stored energy, over this rank's cells.
  [[nodiscard]] std::vector<double> integrals() const {
    constexpr std::size_t square = dim * dim;
    const auto energy = points_.set_.measure(GRAINLAW_ELASTIC_ENERGY);
    const auto volume = points_.set_.measure(GRAINLAW_REFERENCE_VOLUME);
    std::vector<double> sums(square + 1);
    points_.each_cell([&](const auto& cell, std::size_t k) {
      points_.values_.reinit(cell);
      for (std::size_t q = 0, p = k * per_; q < per_; ++q, ++p) {
        const double weight = points_.values_.JxW(static_cast<unsigned>(q));
        for (std::size_t c = 0; c < square; ++c) sums[c] += weight * points_.P_[square * p + c];
        sums[square] += weight * energy[p] / volume[p];
      }
    });
    return sums;
  }

  template <class Vector>
  [[nodiscard]] double farthest(const Vector& all) {
    const auto F = points_.set_.measure(GRAINLAW_DEFORMATION_GRADIENT);
    points_.gradients(all);
    double largest = 0;
    for (std::size_t p = 0; p < F.size(); p += dim * dim) {
      double squares = 0;
      for (std::size_t c = 0; c < dim * dim; ++c)
        squares += std::pow(F[p + c] - points_.F_[p + c] - (c % (dim + 1) == 0 ? 1 : 0), 2);
      largest = std::max(largest, squares);
    }
    return std::sqrt(largest);
  }

  // Where a point of a child lies in the parent.
  [[nodiscard]] ::dealii::Point<dim> in_parent(unsigned child, std::size_t q) const {
    return ::dealii::GeometryInfo<dim>::child_to_cell_coordinates(
        points_.values_.get_quadrature().point(static_cast<unsigned>(q)), child);
  }
  // The first of the nearest, by distance(i) of i < n.
  template <class Distance>
  static std::size_t nearest(std::size_t n, Distance&& distance) {
    std::size_t found = 0;
    double least = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < n; ++i)
      if (const double far = distance(i); far < least - 1e-12) found = i, least = far;
    return found;
  }

  // Length and bytes of each point; a cell to be gets those of its children's points.
  [[nodiscard]] std::vector<char> packed(const Cell& cell, Status status) const {
    std::vector<char> bytes;
    for (std::size_t q = 0; q < per_; ++q) {
      std::size_t from = 0;
      if (status == ::dealii::Triangulation<dim>::CELL_COARSEN) {
        const auto& point = points_.values_.get_quadrature().point(static_cast<unsigned>(q));
        const std::size_t i = nearest(cell->n_children() * per_, [&](std::size_t at) {
          return point.distance(in_parent(static_cast<unsigned>(at / per_), at % per_));
        });
        from = first_point(cell->child(static_cast<unsigned>(i / per_))) + i % per_;
      } else {
        from = first_point(cell) + q;
      }
      const std::uint64_t length = saved_.offsets[from + 1] - saved_.offsets[from];
      const auto* const at = reinterpret_cast<const char*>(&length);
      const auto* const state = reinterpret_cast<const char*>(saved_.bytes.data());
      bytes.insert(bytes.end(), at, at + sizeof length);
      bytes.insert(bytes.end(), state + saved_.offsets[from], state + saved_.offsets[from + 1]);
    }
    return bytes;
  }

  void unpack(const Cell& cell, Status status, const Bytes& bytes) {
    std::vector<std::pair<std::vector<char>::const_iterator, std::uint64_t>> states;
    auto at = bytes.begin();
    for (std::size_t q = 0; q < per_; ++q) {
      std::uint64_t length = 0;
      std::memcpy(&length, &*at, sizeof length);
      at += sizeof length;
      states.emplace_back(at, length);
      at += static_cast<std::ptrdiff_t>(length);
    }
    // Point q of a cell gets states[which(q)].
    const auto load = [&](const Cell& to, auto&& which) {
      std::vector<std::size_t> numbers(per_);
      SavedPoints saved;
      saved.offsets = {0};
      for (std::size_t q = 0; q < per_; ++q) {
        const auto& [state, length] = states[which(q)];
        const auto* const first = reinterpret_cast<const std::byte*>(&*state);
        saved.bytes.insert(saved.bytes.end(), first, first + length);
        saved.offsets.push_back(saved.bytes.size());
        numbers[q] = first_point(to) + q;
      }
      points_.set_.load_some(numbers, saved);
    };
    if (status != ::dealii::Triangulation<dim>::CELL_REFINE)
      return load(cell, [](std::size_t q) { return q; });
    for (unsigned child = 0; child < cell->n_children(); ++child)
      load(cell->child(child), [&](std::size_t q) {
        const auto point = in_parent(child, q);
        return nearest(per_, [&](std::size_t i) {
          return point.distance(points_.values_.get_quadrature().point(static_cast<unsigned>(i)));
        });
      });
  }

  Points<dim>& points_;
  Mesh& mesh_;
  std::size_t per_;                  // points of a cell
  std::vector<std::size_t> places_;  // before, then after
  std::vector<double> whole_;        // integrals, before
  SavedPoints saved_;
  unsigned handle_ = 0;
};

}  // namespace grainlaw::dealii
