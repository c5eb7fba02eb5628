// Texts without a handle.
#include <grainlaw/grainlaw.h>

#define GRAINLAW_STRING(x) #x
#define GRAINLAW_NUMBER(x) GRAINLAW_STRING(x)

const char* grainlaw_version(void) {
  return GRAINLAW_NUMBER(GRAINLAW_VERSION_MAJOR) "." GRAINLAW_NUMBER(
      GRAINLAW_VERSION_MINOR) "." GRAINLAW_NUMBER(GRAINLAW_VERSION_PATCH);
}

const char* grainlaw_status_text(grainlaw_status status) {
  switch (status) {
#define GRAINLAW_X(name, value, text) \
  case name:                          \
    return text;
    GRAINLAW_STATUS_LIST(GRAINLAW_X)
#undef GRAINLAW_X
  }
  return "unknown status";
}
