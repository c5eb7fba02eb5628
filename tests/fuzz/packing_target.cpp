// Any texts as the files of a packing: particles, contacts, cell, each ending in a line of three dashes,
// and lines that are added to the material.
#include "support.hpp"

#include "base/error.hpp"
#include "material/packing_file.hpp"

#include <grainlaw/grainlaw.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::MemoryFile particles, contacts, cell;
  std::string_view text(reinterpret_cast<const char*>(data), size);
  particles.write(fuzz::next_part(text));
  contacts.write(fuzz::next_part(text));
  cell.write(fuzz::next_part(text));
  const std::string more(text);
  if (more.find('\0') != std::string::npos || fuzz::asks_for_much(more)) return -1;
  try {
    const grainlaw::core::PackingPaths paths{particles.path(), contacts.path(), cell.path()};
    if (grainlaw::core::read_packing(paths).size() > 20) return 0;
  } catch (const grainlaw::core::Error& error) {
    EXPECT(error.status == GRAINLAW_BAD_PACKING && error.what()[0] != '\0');
    return 0;
  }

  const std::string toml = "dimension = 2\npacking = { particles = '" + particles.path() +
                           "', contacts = '" + contacts.path() + "', cell = '" + cell.path() +
                           "' }\n" + more;
  char message[300];
  grainlaw_material* material = nullptr;
  const grainlaw_status status =
      grainlaw_material_parse(toml.c_str(), "/", &material, message, sizeof message);
  EXPECT((status == GRAINLAW_OK) == (material != nullptr));
  EXPECT(status != GRAINLAW_INTERNAL_FAULT);
  if (status != GRAINLAW_OK) return 0;
  grainlaw_state* state = nullptr;
  EXPECT(grainlaw_state_create(material, &state) == GRAINLAW_OK);
  const double F[4] = {1, 1e-4, 0, 0.9995};
  double P[4], A[16];
  EXPECT(grainlaw_evaluate(state, F, GRAINLAW_WANT_TANGENT_EXACT, P, A, nullptr) >= 0);
  grainlaw_state_destroy(state);
  grainlaw_material_destroy(material);
  return 0;
}
