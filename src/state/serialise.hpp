// An equilibrium as bytes and back: the same on every machine, and refused when anything is wrong.
#pragma once

#include "increment/configuration.hpp"
#include "material/material.hpp"

#include <cstddef>
#include <span>

namespace grainlaw {

// Bytes that a configuration of this material takes.
[[nodiscard]] std::size_t saved_size(const Material& material, const Configuration& configuration);

// Fills bytes, of saved_size.
void save_configuration(const Material& material, const Configuration& configuration,
                        std::span<std::byte> bytes);

// Any bytes of any length may be given. Throws Error (BAD_BYTES, WRONG_VERSION, WRONG_MATERIAL).
[[nodiscard]] Configuration load_configuration(const Material& material,
                                               std::span<const std::byte> bytes);

}  // namespace grainlaw
