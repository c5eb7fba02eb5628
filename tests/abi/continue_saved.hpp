// What a new process does with a saved state: load it, take the next increment, save again.
#pragma once

#include "support.hpp"

#include <exception>

namespace grainlaw::test {

inline std::vector<std::byte> continue_from(State& state) {
  stress(state, further);
  state.commit();
  return state.save();
}

// 0 when bytes in the file `from` were loaded and what came of them is in the file `to`.
inline int continue_saved(const std::string& from, const std::string& to) {
  try {
    const std::string text = read_text(from);
    State state(material());
    state.load(std::as_bytes(std::span(text)));
    const auto bytes = continue_from(state);
    write_text(to, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    return 0;
  } catch (const std::exception&) {
    return 1;
  }
}

}  // namespace grainlaw::test
