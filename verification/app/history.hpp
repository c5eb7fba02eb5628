// The history of a run: its table, its pictures and its particles, written while it goes.
#pragma once

#include "app/csv.hpp"
#include "app/figure.hpp"
#include "app/record.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace verification {

// Abscissae a scene may choose for its picture.
inline constexpr const char* axial_abscissa = "axial_strain";
inline constexpr const char* shear_abscissa = "F12";
// All of them: shears of spheres are F12, F13 and F23.
std::vector<std::string_view> abscissae(int dimension);

// A caption: "axial strain 2 [%]" or "F12 = 0.1 [-]".
std::string strain_text(const std::string& abscissa, double strain);

// Draws stem.svg and stem.png with stress, volumetric strain and coordination number from a table
// with record_columns(). Colours tell several cycles apart. Returns false without a picture.
bool draw_history(const CsvTable& table, const std::string& abscissa,
                  const std::filesystem::path& stem);

// Drag beyond this share of the mean contact force is told: it then carries what a weak contact does,
// and stress is a per cent or more above that of a slower path [-].
inline constexpr double much_drag = 0.1;

// A line about the largest drag, "" where it is not much.
std::string much_drag_text(const CsvTable& table);

// One line about what the run of such a table cost, with that of a step that did not end, and
// much_drag_text.
std::string history_summary(const CsvTable& table, const Effort& unfinished = {});

class History {
 public:
  // Opens stem.csv, of records of discs or of spheres, with drag or without.
  explicit History(std::filesystem::path stem, int dimension = 2, bool drag = false);

  template <int D>
  void add(const RecordOf<D>& record) {
    csv_.row(record_values(record, drag_));
  }
  [[nodiscard]] bool draw_figure(const std::string& abscissa) const;
  [[nodiscard]] std::string much_drag() const { return much_drag_text(read_csv(csv_.path())); }
  [[nodiscard]] std::string summary(const Effort& unfinished = {}) const;

 private:
  std::filesystem::path stem_;
  bool drag_;
  CsvWriter csv_;
};

}  // namespace verification
