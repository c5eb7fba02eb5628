// Ranks of MPI as one program: what one of them throws ends or is told on all.
#pragma once

#include <deal.II/base/mpi.h>
#include <mpi.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <exception>
#include <grainlaw/grainlaw.hpp>
#include <new>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace grainlaw::dealii {

// A call of all ranks, without calls among them inside: where some throw, all throw a StatusError with
// the text of the lowest of them; one rank alone throws what it was.
template <class Call>
void together(MPI_Comm comm, Call&& call) {
  const int ranks = static_cast<int>(::dealii::Utilities::MPI::n_mpi_processes(comm));
  if (ranks == 1) return call();
  const int rank = static_cast<int>(::dealii::Utilities::MPI::this_mpi_process(comm));
  int status = GRAINLAW_OK;
  std::string text;
  try {
    call();
  } catch (const StatusError& error) {
    status = error.status(), text = error.what();
  } catch (const std::bad_alloc&) {
    status = GRAINLAW_OUT_OF_MEMORY, text = grainlaw_status_text(GRAINLAW_OUT_OF_MEMORY);
  } catch (const std::exception& error) {
    status = GRAINLAW_FILE_ERROR, text = error.what();
  }
  const int mine = status == GRAINLAW_OK ? ranks : rank;
  int first = ranks;
  MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, comm);
  if (first == ranks) return;
  std::array<char, 512> told{};
  text.copy(told.data(), told.size() - 1);
  MPI_Bcast(told.data(), static_cast<int>(told.size()), MPI_CHAR, first, comm);
  MPI_Bcast(&status, 1, MPI_INT, first, comm);
  throw StatusError(static_cast<grainlaw_status>(status),
                    "rank " + std::to_string(first) + ": " + told.data());
}

// The material of a file, read and brought to equilibrium by rank 0, and handed to the others.
inline Material read_material(MPI_Comm comm, const std::string& path) {
  if (::dealii::Utilities::MPI::n_mpi_processes(comm) == 1) return Material::load(path);
  const bool reads = ::dealii::Utilities::MPI::this_mpi_process(comm) == 0;
  std::vector<char> bytes;
  together(comm, [&] {
    if (!reads) return;
    const std::vector<std::byte> saved = Material::load(path).save();
    const auto* const first = reinterpret_cast<const char*>(saved.data());
    bytes.assign(first, first + saved.size());
  });
  bytes = ::dealii::Utilities::MPI::broadcast(comm, bytes, 0);
  return Material::load_saved(std::as_bytes(std::span<const char>(bytes)));
}

// The whole program of a rank: what it throws ends the job. An error that all ranks throw is printed once,
// and 1 returned; any other is printed by its rank, which aborts the job.
template <class Call>
int end_together(MPI_Comm comm, Call&& call) {
  using Clock = std::chrono::steady_clock;
  try {
    call();
    return 0;
  } catch (const std::exception& error) {
    const unsigned rank = ::dealii::Utilities::MPI::this_mpi_process(comm);
    MPI_Request everywhere;
    int arrived = 0;
    MPI_Ibarrier(comm, &everywhere);
    for (const auto until = Clock::now() + std::chrono::seconds(5);
         !arrived && Clock::now() < until;) {
      MPI_Test(&everywhere, &arrived, MPI_STATUS_IGNORE);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    if (!arrived) std::fprintf(stderr, "grainlaw: rank %u: %s\n", rank, error.what());
    if (arrived && rank == 0) std::fprintf(stderr, "grainlaw: %s\n", error.what());
    if (!arrived) MPI_Abort(comm, 1);
    return 1;
  }
}

}  // namespace grainlaw::dealii
