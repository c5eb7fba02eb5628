#include "dns/wave_run.hpp"

#include "app/library.hpp"

namespace verification {

WaveRun run_mesh(const WaveCase& one, const WaveDomain&, int) {
  throw InputError(one.name + ": mesh: explicit dynamics of meshes is not built in");
}

}  // namespace verification
