// Leads representative volumes along short paths and tells every answer as a hash of all its bits:
// P, A, report, measures and the committed bytes. `answers` prints them; `answers FILE` compares with
// those of a file and names the first that differs in every path.
#include "path.hpp"

#include <cstdio>
#include <exception>
#include <fstream>
#include <map>

namespace grainlaw::golden {
namespace {

std::vector<Answer> find_answers() {
  std::vector<Answer> all;
  const On on = [&](const char* name, const std::string& toml, const Lead& lead) {
    Path path(name, toml, all);
    lead(path);
  };
  lead_plane_paths(on);
  lead_space_paths(on);
  lead_drag_paths(on);
  return all;
}

std::map<std::string, std::vector<std::string>> by_paths(const std::vector<Answer>& answers) {
  std::map<std::string, std::vector<std::string>> result;
  for (const Answer& answer : answers) result[answer.path].push_back(answer.text);
  return result;
}

std::vector<Answer> read(const char* file) {
  std::ifstream in(file);
  std::vector<Answer> answers;
  for (std::string line; std::getline(in, line);) {
    const auto space = line.find(' ');
    if (space != std::string::npos)
      answers.push_back({line.substr(0, space), line.substr(space + 1)});
  }
  return answers;
}

int compare(const std::vector<Answer>& found, const std::vector<Answer>& expected) {
  const auto of_file = by_paths(expected);
  const auto here = by_paths(found);
  int differing = 0;
  for (const auto& [path, answers] : here) {
    const auto known = of_file.find(path);
    for (std::size_t k = 0; k < answers.size(); ++k) {
      const std::string before =
          known != of_file.end() && k < known->second.size() ? known->second[k] : "(none)";
      if (answers[k] == before) continue;
      ++differing;
      std::printf("%s differs first at\n  expected %s\n  found    %s\n", path.c_str(),
                  before.c_str(), answers[k].c_str());
      break;
    }
  }
  for (const auto& [path, answers] : of_file) {
    if (here.contains(path) && here.at(path).size() == answers.size()) continue;
    ++differing;
    std::printf("%s: %zu answers expected, found %zu\n", path.c_str(), answers.size(),
                here.contains(path) ? here.at(path).size() : 0);
  }
  std::printf("%zu of %zu paths have the same bits\n",
              here.size() - static_cast<std::size_t>(differing), here.size());
  return differing == 0 && !expected.empty() ? 0 : 1;
}

}  // namespace
}  // namespace grainlaw::golden

int main(int count, char** arguments) {
  using namespace grainlaw::golden;
  try {
    const auto found = find_answers();
    if (count == 2) return compare(found, read(arguments[1]));
    for (const Answer& answer : found)
      std::printf("%s %s\n", answer.path.c_str(), answer.text.c_str());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "answers: %s\n", error.what());
    return 1;
  }
}
