/* A material library as a user writes it; the path is relative to the library. */
#include <grainlaw/calculix.h>

GRAINLAW_CALCULIX_MATERIAL(MISSING, "no_such_material.toml")
GRAINLAW_CALCULIX_MATERIAL(BESIDE, "../small.toml")
