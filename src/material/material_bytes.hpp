// A material as bytes and back, in equilibrium: without its files, and without another relaxation.
#pragma once

#include "material/material.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <variant>
#include <vector>

namespace grainlaw::core {

template <int D>
[[nodiscard]] std::vector<std::byte> save_material(const Material<D>& material);

// The checksum of saved bytes, which follows from all that a material is.
[[nodiscard]] std::uint64_t checksum_of_saved(std::span<const std::byte> bytes);

// Makes the material of bytes that save_material() wrote. Throws Error (BAD_BYTES, WRONG_VERSION)
// for damaged ones; whoever makes a checksum for others is trusted.
[[nodiscard]] std::variant<std::shared_ptr<const Material<2>>, std::shared_ptr<const Material<3>>>
load_saved_material(std::span<const std::byte> bytes);

}  // namespace grainlaw::core
