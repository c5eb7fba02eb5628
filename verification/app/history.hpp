// History of a run: table, pictures and particles, written during the run.
#pragma once

#include "app/csv.hpp"
#include "app/figure.hpp"
#include "app/record.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace verification {

// Abscissae that a scene may choose for its picture.
inline constexpr const char* axial_abscissa = "axial_strain";
inline constexpr const char* shear_abscissa = "F12";

// Draws stem.svg and stem.png with stress, volumetric strain and coordination number from a table
// with record_columns(). Returns false without a picture.
bool draw_history(const CsvTable& table, const std::string& abscissa, const std::string& title,
                  const std::filesystem::path& stem);

// One line with the cost of the run of such a table, and that of an unfinished step.
std::string history_summary(const CsvTable& table, const Effort& unfinished = {});

class History {
 public:
  // Opens stem.csv for records of discs or spheres.
  explicit History(std::filesystem::path stem,
                   const std::vector<std::string>& columns = record_columns());

  template <int D>
  void add(const RecordOf<D>& record) {
    csv_.row(record_values(record));
  }
  bool draw_figure(const std::string& abscissa, const std::string& title) const;
  [[nodiscard]] std::string summary(const Effort& unfinished = {}) const;

 private:
  std::filesystem::path stem_;
  CsvWriter csv_;
};

// Writes stem_0010.vtp: particles and force chains of the state. Throws ComputationError.
void write_vtk(const grainlaw_state* state, const std::filesystem::path& stem, int step);

}  // namespace verification
