// The history of a run: its table, its pictures and its particles, written while it goes.
#pragma once

#include "app/csv.hpp"
#include "app/figure.hpp"
#include "app/record.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace verification {

// Abscissae a scene may choose for its picture.
inline constexpr const char* axial_abscissa = "axial_strain";
inline constexpr const char* shear_abscissa = "F12";

// Of a table with record_columns(): stem.svg and stem.png with stress, volumetric strain and
// coordination number. False without a picture.
bool draw_history(const CsvTable& table, const std::string& abscissa, const std::string& title,
                  const std::filesystem::path& stem);

// One line about what the run of such a table cost, with that of a step that did not end.
std::string history_summary(const CsvTable& table, const Effort& unfinished = {});

class History {
 public:
  // Opens stem.csv, of records of discs or of spheres.
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

}  // namespace verification
