// Numbers that statements of the papers are judged by; statements.py makes the verdicts.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace verification {

class Facts {
 public:
  // `head` stands before every name: the paper, "liu2017".
  explicit Facts(std::string head) : head_(std::move(head)) {}

  // What is no number could not be measured, and is left out.
  void add(const std::string& name, double value);
  // HEAD_facts.csv, with commit and machine from machine.csv there.
  void write(const std::filesystem::path& directory) const;

 private:
  std::string head_;
  std::vector<std::pair<std::string, double>> values_;
};

}  // namespace verification
