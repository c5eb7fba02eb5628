#include "io/csv_records.hpp"

namespace grainlaw::core {

bool CsvRecords::next(std::vector<std::string>& fields) {
  if (rest_.empty()) return false;
  line_ = next_line_;
  std::size_t count = 0, k = 0;
  const auto begin_field = [&] {
    if (count == fields.size()) fields.emplace_back();
    fields[count++].clear();
  };
  begin_field();
  bool quoted = false, ended = false;
  for (; k < rest_.size() && !ended; ++k) {
    const char c = rest_[k];
    const char after = k + 1 < rest_.size() ? rest_[k + 1] : '\0';
    std::string& field = fields[count - 1];
    if (c == '\n') ++next_line_;
    if (c == '"' && quoted && after == '"') {
      field += c;
      ++k;
    } else if (c == '"' && (quoted || field.empty())) {
      quoted = !quoted;
    } else if (quoted) {
      field += c;
    } else if (c == ',') {
      begin_field();
    } else if (c == '\n') {
      ended = true;
    } else if (c != '\r' || (after != '\n' && k + 1 < rest_.size())) {
      field += c;
    }
  }
  open_ = quoted;
  fields.resize(count);
  rest_.remove_prefix(k);
  return true;
}

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

std::string csv_record(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) line += csv_field(field) + ',';
  if (!fields.empty()) line.pop_back();
  return line + '\n';
}

}  // namespace grainlaw::core
