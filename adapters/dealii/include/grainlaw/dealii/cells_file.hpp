// States of the cells of a mesh in one HDF5 file, which any number of ranks of MPI writes and reads.
// They are found by the cells' numbers in the whole mesh. The layout is that of grainlaw.checkpoint in
// Python:
//
//   attributes  "format" (a text), "version", "points" of a cell, "fingerprint" of the material, "load"
//   "unknowns"  (cells, k)
//   "lengths"   (cells, points): bytes of each point
//   "starts"    (cells): where those of a cell begin in "states"
//   "states"    (bytes)
#pragma once

#include <deal.II/base/config.h>
#include <fcntl.h>
#include <mpi.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <grainlaw/dealii/ranks.hpp>
#include <numeric>
#include <string>
#include <vector>

#ifdef DEAL_II_WITH_HDF5
#include <hdf5.h>
#endif

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

#ifndef DEAL_II_WITH_HDF5

inline void Cells::save(const std::string&, double) const {
  throw StatusError(GRAINLAW_FILE_ERROR, "checkpoints need a deal.II with HDF5");
}
inline double Cells::load(const std::string&) {
  throw StatusError(GRAINLAW_FILE_ERROR, "checkpoints need a deal.II with HDF5");
}

#else

namespace cells_file {

static_assert(sizeof(hsize_t) == sizeof(std::uint64_t));
#ifndef H5_HAVE_PARALLEL
#error "checkpoints of ranks need an HDF5 with MPI, as that of Debian's deal.II"
#endif

constexpr char format[] = "grainlaw states of cells";
constexpr std::int64_t version = 2;
using Extent = std::vector<hsize_t>;

// What HDF5 gave, until it is closed.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const std::string& what,
         grainlaw_status status = GRAINLAW_BAD_BYTES)
      : id_(id), close_(close) {
    if (id < 0) throw StatusError(status, what);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { close_(id_); }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

inline Handle space(const Extent& extent) {
  return {H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose,
          "no memory for a space of HDF5"};
}

// A file that all ranks open and close together; HDF5 itself prints no errors meanwhile.
class File {
 public:
  File(MPI_Comm comm, const std::string& path, bool creates) {
    H5Eget_auto2(H5E_DEFAULT, &print_, &to_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "no memory for HDF5");
    H5Pset_fapl_mpio(access, comm, MPI_INFO_NULL);
    try {
      together(comm, [&] {
        id_ = creates ? H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access)
                      : H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
        if (id_ >= 0) return;
        if (creates || ::access(path.c_str(), R_OK) != 0)
          throw StatusError(GRAINLAW_FILE_ERROR, path + ": cannot be opened");
        throw StatusError(GRAINLAW_BAD_BYTES, path + ": is cut short, or no HDF5 file");
      });
    } catch (...) {
      close();
      throw;
    }
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() { close(); }
  operator hid_t() const { return id_; }

 private:
  void close() {
    if (id_ >= 0) H5Fclose(id_);
    H5Eset_auto2(H5E_DEFAULT, print_, to_);
  }
  hid_t id_ = -1;
  H5E_auto2_t print_ = nullptr;
  void* to_ = nullptr;
};

// A dataset, which is created where its extent is given.
class Dataset {
 public:
  Dataset(const File& file, const char* name, hid_t type, const Extent& extent)
      : id_(H5Dcreate2(file, name, type, space(extent), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
            H5Dclose, std::string(name) + " cannot be written", GRAINLAW_FILE_ERROR) {}
  Dataset(const File& file, const char* name)
      : id_(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose,
            "the checkpoint has no " + std::string(name)) {}

  [[nodiscard]] Extent extent() const {
    const Handle all(H5Dget_space(id_), H5Sclose, "a damaged dataset");
    Extent extent(static_cast<std::size_t>(H5Sget_simple_extent_ndims(all)));
    H5Sget_simple_extent_dims(all, extent.data(), nullptr);
    return extent;
  }
  void write(hid_t type, const Extent& start, const Extent& count, const void* data) const {
    const Handle all(H5Dget_space(id_), H5Sclose, "a damaged dataset");
    H5Sselect_hyperslab(all, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
    if (H5Dwrite(id_, type, space(count), all, H5P_DEFAULT, data) < 0)
      throw StatusError(GRAINLAW_FILE_ERROR, "the checkpoint cannot be written");
  }
  void read(hid_t type, const Extent& start, const Extent& count, void* data) const {
    const Handle all(H5Dget_space(id_), H5Sclose, "a damaged dataset");
    if (H5Sselect_hyperslab(all, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) <
            0 ||
        H5Dread(id_, type, space(count), all, H5P_DEFAULT, data) < 0)
      throw StatusError(GRAINLAW_BAD_BYTES, "the checkpoint is damaged");
  }

 private:
  Handle id_;
};

inline void put(const File& file, const char* name, hid_t type, const void* value) {
  const Handle one(H5Screate(H5S_SCALAR), H5Sclose, "no memory for HDF5");
  const Handle at(H5Acreate2(file, name, type, one, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                  std::string(name) + " cannot be written", GRAINLAW_FILE_ERROR);
  if (H5Awrite(at, type, value) < 0)
    throw StatusError(GRAINLAW_FILE_ERROR, std::string(name) + " cannot be written");
}

template <class Value>
Value get(const File& file, const char* name, hid_t type) {
  const Handle at(H5Aopen(file, name, H5P_DEFAULT), H5Aclose, "expected a checkpoint of cells");
  Value value{};
  if (H5Aread(at, type, &value) < 0)
    throw StatusError(GRAINLAW_BAD_BYTES, "expected a checkpoint of cells");
  return value;
}

// The type of a text, as h5py writes it.
class TextType : public Handle {
 public:
  TextType() : Handle(H5Tcopy(H5T_C_S1), H5Tclose, "no memory for HDF5") {
    H5Tset_size(*this, H5T_VARIABLE);
    H5Tset_cset(*this, H5T_CSET_UTF8);
  }
};

inline std::vector<std::size_t> points_of(const Cells& cells, std::size_t k) {
  std::vector<std::size_t> which(cells.points_per_cell);
  std::iota(which.begin(), which.end(), k * cells.points_per_cell);
  return which;
}

inline double check(const Cells& cells, const File& file) {
  const auto same = [](const char* what, std::uint64_t found, std::uint64_t expected) {
    if (found != expected)
      throw StatusError(GRAINLAW_BAD_ARGUMENT, "the checkpoint has " + std::to_string(found) +
                                                   what + ", expected " + std::to_string(expected));
  };
  const TextType type;
  char* const found = get<char*>(file, "format", type);
  const bool known = found != nullptr && std::strcmp(found, format) == 0;
  H5free_memory(found);
  if (!known) throw StatusError(GRAINLAW_BAD_BYTES, "expected a checkpoint of cells");
  if (get<std::int64_t>(file, "version", H5T_NATIVE_INT64) != version)
    throw StatusError(GRAINLAW_WRONG_VERSION, "expected version " + std::to_string(version));
  if (get<std::uint64_t>(file, "fingerprint", H5T_NATIVE_UINT64) != cells.fingerprint)
    throw StatusError(GRAINLAW_WRONG_MATERIAL, "the checkpoint is of another material");
  const Extent unknowns = Dataset(file, "unknowns").extent();
  if (unknowns.size() != 2) throw StatusError(GRAINLAW_BAD_BYTES, "the checkpoint is damaged");
  same(" cells", unknowns[0], cells.total);
  same(" points in a cell", get<std::uint64_t>(file, "points", H5T_NATIVE_UINT64),
       cells.points_per_cell);
  same(" unknowns at a cell", unknowns[1], cells.unknowns_per_cell);
  return get<double>(file, "load", H5T_NATIVE_DOUBLE);
}

// Tell a disk that is too full before HDF5 begins: it crashes as it closes what it cannot write.
inline void reserve(MPI_Comm comm, int rank, const std::string& path, std::uint64_t size) {
  together(comm, [&] {
    if (rank != 0) return;
    const int file = ::open(path.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0666);
    const int wrong = file < 0 ? errno : posix_fallocate(file, 0, static_cast<off_t>(size));
    if (file >= 0) ::close(file);
    if (wrong != 0) throw StatusError(GRAINLAW_FILE_ERROR, path + ": " + std::strerror(wrong));
  });
}

}  // namespace cells_file

inline void Cells::save(const std::string& path, double load) const {
  using namespace cells_file;
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  const hsize_t per = points_per_cell;
  std::vector<std::uint64_t> lengths, starts;
  std::uint64_t bytes = 0, start = 0, every = 0;
  together(comm, [&] {
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      const SavedPoints saved = points->save_some(points_of(*this, k));
      starts.push_back(bytes);
      for (std::size_t q = 0; q < per; ++q)
        lengths.push_back(saved.offsets[q + 1] - saved.offsets[q]);
      bytes += saved.bytes.size();
    }
  });
  MPI_Exscan(&bytes, &start, 1, MPI_UINT64_T, MPI_SUM, comm);
  if (rank == 0) start = 0;
  MPI_Allreduce(&bytes, &every, 1, MPI_UINT64_T, MPI_SUM, comm);
  long process = getpid();
  MPI_Bcast(&process, 1, MPI_LONG, 0, comm);
  const std::string beside = path + "." + std::to_string(process) + ".new";
  try {
    reserve(comm, rank, beside, every + 8 * total * (unknowns_per_cell + per + 1) + 8192);
    {
      const File file(comm, beside, true);
      const char* const text = format;
      const std::int64_t of_cell = points_per_cell;
      put(file, "format", TextType(), &text);
      put(file, "version", H5T_NATIVE_INT64, &version);
      put(file, "load", H5T_NATIVE_DOUBLE, &load);
      put(file, "points", H5T_NATIVE_INT64, &of_cell);
      put(file, "fingerprint", H5T_NATIVE_UINT64, &fingerprint);
      const Dataset values(file, "unknowns", H5T_IEEE_F64LE, {total, unknowns_per_cell});
      const Dataset table(file, "lengths", H5T_STD_U64LE, {total, per});
      const Dataset begins(file, "starts", H5T_STD_U64LE, {total});
      const Dataset states(file, "states", H5T_STD_U8LE, {every});
      together(comm, [&] {
        for (std::size_t k = 0; k < numbers.size(); ++k) {
          const std::uint64_t begin = start + starts[k];
          const SavedPoints saved = points->save_some(points_of(*this, k));
          begins.write(H5T_NATIVE_UINT64, {numbers[k]}, {1}, &begin);
          table.write(H5T_NATIVE_UINT64, {numbers[k], 0}, {1, per}, &lengths[k * per]);
          values.write(H5T_NATIVE_DOUBLE, {numbers[k], 0}, {1, unknowns_per_cell},
                       unknowns.data() + k * unknowns_per_cell);
          states.write(H5T_NATIVE_UINT8, {begin}, {saved.bytes.size()}, saved.bytes.data());
        }
      });
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
  const File file(comm, path, false);
  double load = 0;
  together(comm, [&] {
    load = check(*this, file);
    const Dataset values(file, "unknowns"), table(file, "lengths"), begins(file, "starts"),
        states(file, "states");
    const hsize_t per = points_per_cell, every = states.extent().at(0);
    for (std::size_t k = 0; k < numbers.size(); ++k) try {
        std::uint64_t begin = 0, size = 0;
        std::vector<std::uint64_t> lengths(per);
        begins.read(H5T_NATIVE_UINT64, {numbers[k]}, {1}, &begin);
        table.read(H5T_NATIVE_UINT64, {numbers[k], 0}, {1, per}, lengths.data());
        values.read(H5T_NATIVE_DOUBLE, {numbers[k], 0}, {1, unknowns_per_cell},
                    unknowns.data() + k * unknowns_per_cell);
        SavedPoints saved;
        for (const std::uint64_t length : lengths) {
          if (length > every) throw StatusError(GRAINLAW_BAD_BYTES, "its states are cut short");
          size += length;
          saved.offsets.push_back(size);
        }
        if (begin > every || size > every - begin)
          throw StatusError(GRAINLAW_BAD_BYTES, "its states are cut short");
        saved.bytes.resize(size);
        states.read(H5T_NATIVE_UINT8, {begin}, {size}, saved.bytes.data());
        points->load_some(points_of(*this, k), saved);
      } catch (const StatusError& error) {
        throw StatusError(error.status(),
                          path + ", cell " + std::to_string(numbers[k]) + ": " + error.what());
      }
  });
  return load;
}

#endif

}  // namespace grainlaw::dealii
