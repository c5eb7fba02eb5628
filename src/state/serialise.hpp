// An equilibrium as bytes and back: the same on every machine, and refused when anything is wrong.
#pragma once

#include "increment/configuration.hpp"
#include "material/material.hpp"
#include "state/time_step.hpp"

#include <cstddef>
#include <span>

namespace grainlaw::core {

// Bytes that a configuration of this material takes.
template <int D>
[[nodiscard]] std::size_t saved_size(const Material<D>& material,
                                     const Configuration<D>& configuration);

// Fills bytes, of saved_size. The time step is kept where the material asks for it.
template <int D>
void save_configuration(const Material<D>& material, const Configuration<D>& configuration,
                        std::span<std::byte> bytes, double time_step = untold);

// Any bytes of any length may be given. Throws Error (BAD_BYTES, WRONG_VERSION, WRONG_MATERIAL).
template <int D>
[[nodiscard]] Configuration<D> load_configuration(const Material<D>& material,
                                                  std::span<const std::byte> bytes,
                                                  double* time_step = nullptr);

}  // namespace grainlaw::core
