// The system calls of a save, one of which fails: they are defined here, in the program, and so go
// before those of the C library.
#pragma once

namespace grainlaw::test {

// Calls of open, write, fsync, close and rename are counted from now on. The one of this number,
// from 1, fails; 0: none does.
void fail_call(int number);
int calls();

}  // namespace grainlaw::test
