// States of the cells of a mesh in one file, which any number of ranks of MPI writes and reads: a record
// for each cell, found by its number in the whole mesh.
//
// The file, little endian: "GRAINCEL", u32 version 1, u32 points of a cell, u64 cells, u64 fingerprint
// of the material, u64 unknowns of a cell, f64 load; for each cell u64 start and u64 length of its
// record; records: u64 length of each point's bytes, f64 unknowns, the points' bytes.
#pragma once

#include <mpi.h>
#include <unistd.h>

#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <grainlaw/dealii/ranks.hpp>
#include <numeric>
#include <string>
#include <vector>

namespace grainlaw::dealii {

// The points of the cells that a rank owns, and the unknowns at these cells.
struct Cells {
  MPI_Comm comm = MPI_COMM_NULL;
  grainlaw::Points* points = nullptr;  // by cell, points_per_cell of each
  unsigned long long fingerprint = 0;  // of the material
  std::vector<std::uint64_t> numbers;  // of the cells in the whole mesh, from 0
  std::uint64_t total = 0;             // cells of the whole mesh
  std::uint32_t points_per_cell = 0;
  std::uint64_t unknowns_per_cell = 0;  // on all ranks
  std::vector<double> unknowns;         // by cell

  // Write the committed states of all ranks to one file: the old one or the whole new one. Throws
  // StatusError on all ranks.
  void save(const std::string& path, double load) const;
  // Replace the committed states of fresh points and `unknowns` by those of a file. The load. Throws
  // StatusError on all ranks; points and unknowns are then undefined.
  double load(const std::string& path);
};

namespace cells_file {

static_assert(std::endian::native == std::endian::little, "the file is of little endian machines");

struct Head {
  char magic[8] = {'G', 'R', 'A', 'I', 'N', 'C', 'E', 'L'};
  std::uint32_t version = 1, points_per_cell = 0;
  std::uint64_t cells = 0, fingerprint = 0, unknowns_per_cell = 0;
  double load = 0;
};
static_assert(sizeof(Head) == 48);

// Start and length of a cell's record.
struct Entry {
  std::uint64_t start = 0, length = 0;
};

inline MPI_Offset entry_of(std::uint64_t number) {
  return static_cast<MPI_Offset>(sizeof(Head) + sizeof(Entry) * number);
}

// A file that all ranks open and close together.
class File {
 public:
  File(MPI_Comm comm, const std::string& path, int mode) {
    together(comm, [&] {
      if (MPI_File_open(comm, path.c_str(), mode, MPI_INFO_NULL, &file_) != MPI_SUCCESS)
        throw StatusError(GRAINLAW_FILE_ERROR, path + ": cannot be opened");
    });
    if ((mode & MPI_MODE_RDONLY) != 0) MPI_File_get_size(file_, &size_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() { MPI_File_close(&file_); }

  void write(MPI_Offset start, const void* data, std::size_t length) {
    const int count = static_cast<int>(length);
    MPI_Status status;
    int written = 0;
    if (MPI_File_write_at(file_, start, data, count, MPI_BYTE, &status) == MPI_SUCCESS)
      MPI_Get_count(&status, MPI_BYTE, &written);
    if (written != count) throw StatusError(GRAINLAW_FILE_ERROR, "the disk is full");
  }
  void read(MPI_Offset start, void* data, std::size_t length) {
    if (start < 0 || start > size_ || length > static_cast<std::size_t>(size_ - start))
      throw StatusError(GRAINLAW_BAD_BYTES, "the checkpoint is cut short");
    MPI_File_read_at(file_, start, data, static_cast<int>(length), MPI_BYTE, MPI_STATUS_IGNORE);
  }
  void sync() { MPI_File_sync(file_); }

 private:
  MPI_File file_ = MPI_FILE_NULL;
  MPI_Offset size_ = 0;
};

inline std::vector<std::size_t> points_of(const Cells& cells, std::size_t k) {
  std::vector<std::size_t> which(cells.points_per_cell);
  std::iota(which.begin(), which.end(), k * cells.points_per_cell);
  return which;
}

inline std::vector<std::byte> record(const Cells& cells, std::size_t k) {
  const SavedPoints saved = cells.points->save_some(points_of(cells, k));
  std::vector<std::byte> bytes;
  const auto put = [&](const void* data, std::size_t length) {
    const auto* const first = static_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), first, first + length);
  };
  for (std::size_t q = 0; q < cells.points_per_cell; ++q) {
    const std::uint64_t length = saved.offsets[q + 1] - saved.offsets[q];
    put(&length, sizeof length);
  }
  put(cells.unknowns.data() + k * cells.unknowns_per_cell,
      cells.unknowns_per_cell * sizeof(double));
  put(saved.bytes.data(), saved.bytes.size());
  return bytes;
}

inline void take(Cells& cells, std::size_t k, const std::vector<std::byte>& bytes) {
  const std::size_t lengths = cells.points_per_cell * sizeof(std::uint64_t);
  const std::size_t head = lengths + cells.unknowns_per_cell * sizeof(double);
  SavedPoints saved;
  for (std::size_t q = 0; q < cells.points_per_cell && bytes.size() >= head; ++q) {
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data() + q * sizeof length, sizeof length);
    if (length > bytes.size()) break;
    saved.offsets.push_back(saved.offsets.back() + length);
  }
  if (saved.offsets.size() != cells.points_per_cell + 1U ||
      saved.offsets.back() + head != bytes.size())
    throw StatusError(GRAINLAW_BAD_BYTES, "its record is damaged");
  std::memcpy(cells.unknowns.data() + k * cells.unknowns_per_cell, bytes.data() + lengths,
              head - lengths);
  saved.bytes.assign(bytes.begin() + static_cast<std::ptrdiff_t>(head), bytes.end());
  cells.points->load_some(points_of(cells, k), saved);
}

inline void check(const Cells& cells, const Head& head) {
  const auto same = [](const char* what, std::uint64_t found, std::uint64_t expected) {
    if (found != expected)
      throw StatusError(GRAINLAW_BAD_ARGUMENT, "the checkpoint has " + std::to_string(found) +
                                                   what + ", expected " + std::to_string(expected));
  };
  if (std::memcmp(head.magic, Head().magic, sizeof head.magic) != 0)
    throw StatusError(GRAINLAW_BAD_BYTES, "expected a checkpoint of cells");
  if (head.version != 1) throw StatusError(GRAINLAW_WRONG_VERSION, "expected version 1");
  if (head.fingerprint != cells.fingerprint)
    throw StatusError(GRAINLAW_WRONG_MATERIAL, "the checkpoint is of another material");
  same(" cells", head.cells, cells.total);
  same(" points in a cell", head.points_per_cell, cells.points_per_cell);
  same(" unknowns at a cell", head.unknowns_per_cell, cells.unknowns_per_cell);
}

}  // namespace cells_file

inline void Cells::save(const std::string& path, double load) const {
  using namespace cells_file;
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  std::vector<Entry> entries(numbers.size());
  std::uint64_t bytes = 0, start = 0;
  together(comm, [&] {
    for (std::size_t k = 0; k < entries.size(); ++k) {
      entries[k] = {bytes, record(*this, k).size()};
      bytes += entries[k].length;
    }
  });
  MPI_Exscan(&bytes, &start, 1, MPI_UINT64_T, MPI_SUM, comm);
  if (rank == 0) start = 0;
  long process = getpid();
  MPI_Bcast(&process, 1, MPI_LONG, 0, comm);
  const std::string beside = path + "." + std::to_string(process) + ".new";
  try {
    {
      File file(comm, beside, MPI_MODE_CREATE | MPI_MODE_WRONLY);
      together(comm, [&] {
        Head head;
        head.points_per_cell = points_per_cell, head.cells = total;
        head.fingerprint = fingerprint, head.unknowns_per_cell = unknowns_per_cell;
        head.load = load;
        if (rank == 0) file.write(0, &head, sizeof head);
        for (std::size_t k = 0; k < entries.size(); ++k) {
          Entry& entry = entries[k];
          entry.start += start + static_cast<std::uint64_t>(entry_of(total));
          file.write(entry_of(numbers[k]), &entry, sizeof entry);
          const std::vector<std::byte> data = record(*this, k);
          file.write(static_cast<MPI_Offset>(entry.start), data.data(), data.size());
        }
      });
      file.sync();
    }
    together(comm, [&] {
      if (rank == 0 && std::rename(beside.c_str(), path.c_str()) != 0)
        throw StatusError(GRAINLAW_FILE_ERROR, path + ": cannot be replaced");
    });
  } catch (const StatusError&) {
    if (rank == 0) std::remove(beside.c_str());
    throw;
  }
}

inline double Cells::load(const std::string& path) {
  using namespace cells_file;
  File file(comm, path, MPI_MODE_RDONLY);
  Head head;
  together(comm, [&] {
    file.read(0, &head, sizeof head);
    check(*this, head);
    for (std::size_t k = 0; k < numbers.size(); ++k) try {
        Entry entry;
        file.read(entry_of(numbers[k]), &entry, sizeof entry);
        // Read as far as the file goes: a damaged length allocates nothing.
        std::byte last{};
        if (entry.length > 0)
          file.read(static_cast<MPI_Offset>(entry.start + entry.length - 1), &last, 1);
        std::vector<std::byte> bytes(entry.length);
        file.read(static_cast<MPI_Offset>(entry.start), bytes.data(), bytes.size());
        take(*this, k, bytes);
      } catch (const StatusError& error) {
        throw StatusError(error.status(),
                          path + ", cell " + std::to_string(numbers[k]) + ": " + error.what());
      }
  });
  return head.load;
}

}  // namespace grainlaw::dealii
