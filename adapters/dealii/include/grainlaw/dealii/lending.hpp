// Points of a mesh lent between ranks. Needs the target grainlaw::lending; dealii.hpp does not include it.
#pragma once

#include <grainlaw/lending.h>
#include <array>
#include <exception>
#include <grainlaw/dealii/points.hpp>
#include <grainlaw/dealii/ranks.hpp>

namespace grainlaw::dealii {

// While it lives, ranks that are done with their own points evaluate points of others, with the same bits.
// All ranks make and end it together, within the life of the points.
template <int dim>
class Lending {
 public:
  // Throws StatusError on all ranks.
  Lending(Points<dim>& points, const Material& material) : points_(points) {
    std::array<char, 256> message{};
    const grainlaw_material* const materials = material.get();
    const grainlaw_status status =
        grainlaw_lending_create(MPI_Comm_c2f(points.comm_), points.set_.get(), 1, &materials,
                                nullptr, &handle_, message.data(), message.size());
    if (status != GRAINLAW_OK) {
      points_.share();
      throw StatusError(status, message.data());
    }
    points_.evaluate_ = [this](std::span<const double> F, std::span<double> P,
                               std::span<double> A) {
      PointsEvaluation found;
      found.status =
          grainlaw_lending_evaluate(handle_, F.data(), GRAINLAW_WANT_TANGENT_EXACT, P.data(),
                                    A.data(), nullptr, nullptr, &found.summary);
      if (found.status < 0) throw StatusError(found.status, found.message());
      return found;
    };
  }
  ~Lending() {
    points_.evaluate_ = nullptr;
    if (std::uncaught_exceptions() > 0) return;  // others may not come
    grainlaw_lending_destroy(handle_);
    points_.share();
  }
  Lending(const Lending&) = delete;
  Lending& operator=(const Lending&) = delete;

  // What it did on this rank so far.
  [[nodiscard]] grainlaw_lent count() const { return grainlaw_lending_count(handle_); }

 private:
  Points<dim>& points_;
  grainlaw_lending* handle_ = nullptr;
};

}  // namespace grainlaw::dealii
