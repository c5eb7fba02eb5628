// toml++ as this project uses it. A guard instead of "pragma once": the file is part of a precompiled
// header, where compiler caches give it another path.
#ifndef GRAINLAW_IO_TOML_HPP
#define GRAINLAW_IO_TOML_HPP

// toml++ assumes things of a text before it has looked, and then either aborts or, without assertions,
// lets the compiler rely on them: "[.a" is enough. Wrong texts are its errors, nothing else.
#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(condition) static_cast<void>(0)
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

#endif
