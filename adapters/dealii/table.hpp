// Tables of numbers that the examples write.
#pragma once

#include <string>
#include <vector>

#include "../point/number_text.hpp"
#include "../point/whole_file.hpp"

// Written whole after every load step: on a full disk the steps before it stay.
class CsvTable {
 public:
  CsvTable(const std::string& path, const std::string& head) : path_(path), text_(head + "\n") {}
  void add(const std::vector<double>& row) {
    for (std::size_t k = 0; k < row.size(); ++k)
      text_ += (k == 0 ? "" : ",") + grainlaw::adapters::shown(row[k], 17);
    text_ += "\n";
  }
  void save() const {
    grainlaw::adapters::WholeFile file(path_);
    file.write(text_.data(), text_.size());
    file.keep();
  }

 private:
  std::string path_, text_;
};
