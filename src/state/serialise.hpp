// A state as bytes and back: portable, and refused when damaged.
#pragma once

#include "increment/configuration.hpp"
#include "material/material.hpp"
#include "state/reference.hpp"
#include "state/time_step.hpp"

#include <cstddef>
#include <optional>
#include <span>

namespace grainlaw::core {

// What bytes hold of a state.
template <int D>
struct SavedStateOf {
  Configuration<D> committed;
  double time_step = untold;
  std::optional<Reference<D>> reference;
};

// Size of a saved configuration of this material in bytes.
template <int D>
[[nodiscard]] std::size_t saved_size(const Material<D>& material,
                                     const Configuration<D>& configuration,
                                     const std::optional<Reference<D>>& reference = {});

// Writes saved_size() bytes, with the time step where the material asks for it.
template <int D>
void save_configuration(const Material<D>& material, const Configuration<D>& configuration,
                        std::span<std::byte> bytes, double time_step = untold,
                        const std::optional<Reference<D>>& reference = {});

// Loads a state from any bytes of any length. Throws Error (BAD_BYTES, WRONG_VERSION,
// WRONG_MATERIAL).
template <int D>
[[nodiscard]] SavedStateOf<D> load_configuration(const Material<D>& material,
                                                 std::span<const std::byte> bytes);

}  // namespace grainlaw::core
