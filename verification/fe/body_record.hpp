// Record of a body after a load step, in the dimension of its material.
#pragma once

#include "app/record.hpp"
#include "fe/dimension.hpp"

namespace verification {

// Means over the integration points; tensors have two or three rows.
struct BodyRecord : RecordNumbers {
  using Tensor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 3, 3>;

  BodyRecord() = default;
  template <int D>
  explicit BodyRecord(const RecordOf<D>& record)
      : RecordNumbers(record),
        deformation(record.deformation),
        stress(record.stress),
        cauchy(record.cauchy),
        fabric(record.fabric) {}

  [[nodiscard]] int dimension() const { return static_cast<int>(deformation.rows()); }
  template <int D>
  [[nodiscard]] RecordOf<D> in() const {
    RecordOf<D> record;
    static_cast<RecordNumbers&>(record) = *this;
    record.deformation = deformation;
    record.stress = stress;
    record.cauchy = cauchy;
    record.fabric = fabric;
    return record;
  }
  // Values of record_columns().
  [[nodiscard]] std::vector<double> values(bool drag) const {
    return in_dimension(dimension(), [&]<int D>() { return record_values<D>(in<D>(), drag); });
  }

  // Axial axis: the last one. Axial strain 1 - F, compression positive; p = -tr sigma / D [Pa].
  [[nodiscard]] double axial_strain() const {
    return 1 - deformation(dimension() - 1, dimension() - 1);
  }
  [[nodiscard]] double mean_pressure() const { return -cauchy.trace() / dimension(); }

  Tensor deformation, stress, cauchy, fabric;  // as in RecordOf
};

}  // namespace verification
