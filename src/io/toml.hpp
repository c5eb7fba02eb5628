// toml++ as this project uses it. A guard replaces "pragma once", since the file is part of a
// precompiled header, which compiler caches store under another path.
#ifndef GRAINLAW_IO_TOML_HPP
#define GRAINLAW_IO_TOML_HPP

// toml++ asserts conditions of a text before it has checked them. It then aborts or, without
// assertions, lets the compiler rely on them: "[.a" suffices. Here a wrong text gives its error and
// nothing else.
#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(condition) static_cast<void>(0)
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

#endif
