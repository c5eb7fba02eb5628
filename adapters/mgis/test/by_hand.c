/* A behaviour library as a user writes it: several materials, paths relative to the library. */
#include <grainlaw/mgis.h>

GRAINLAW_MGIS_BEHAVIOUR(Missing, "no_such_material.toml")
GRAINLAW_MGIS_BEHAVIOUR(Beside, "../small.toml")
GRAINLAW_MGIS_BEHAVIOUR(Named, "no_such_material.toml") /* named by GRAINLAW_MATERIAL_Named */
