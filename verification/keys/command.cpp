#include "app/commands.hpp"
#include "app/scene.hpp"
#include "keys/keys.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <iterator>
#include <memory>

namespace verification {
namespace {

// Quoted words without the leading "one of".
std::string range_of(const Key& key) {
  std::string text = key.asked.expected;
  constexpr std::string_view needless = "one of \"";
  for (std::size_t at = 0; (at = text.find(needless, at)) != std::string::npos;)
    text.erase(at, needless.size() - 1);
  return text;
}

// Text without the links of a page.
std::string plain(std::string_view text) {
  std::string result;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text.substr(at, 2) == "](")
      at = text.find(')', at);
    else if (text[at] != '[')
      result += text[at];
  }
  return result;
}

std::string fallback_of(const Key& key) {
  return key.asked.fallback.empty() ? "none" : key.asked.fallback;
}

std::string table_of(const std::string& path) {
  const auto dot = path.rfind('.');
  return dot == std::string::npos ? "" : path.substr(0, dot);
}

void print_markdown(const std::vector<Key>& keys) {
  std::string table = "none yet";
  for (const Key& key : keys) {
    if (const std::string now = table_of(key.asked.path); now != table) {
      table = now;
      fmt::print("{}\n| key | unit | default | value | meaning |\n|---|---|---|---|---|\n",
                 table.empty() ? "" : fmt::format("\n`[{}]`\n", table));
    }
    const std::string name = key.asked.path.substr(table.empty() ? 0 : table.size() + 1);
    fmt::print("| `{}` | {} | {} | {} | {} |\n", name, key.unit, as_cell(fallback_of(key)),
               as_cell(range_of(key)), as_cell(key.meaning));
  }
}

void print_list(const std::vector<Key>& keys) {
  for (const Key& key : keys)
    fmt::print("{:<40} default {:<12} {}{}{}\n", key.asked.path, fallback_of(key), range_of(key),
               key.unit.empty() || key.unit == "-" ? "" : fmt::format(" [{}]", key.unit),
               key.meaning.empty() ? "" : fmt::format("\n    {}", plain(key.meaning)));
}

}  // namespace

std::string as_cell(std::string_view text) {
  std::string cell;
  for (const char c : text) cell += c == '|' ? std::string("\\|") : std::string(1, c);
  return cell;
}

void add_keys_command(CLI::App& app) {
  struct Options {
    std::string of;
    bool markdown = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "keys", "list the keys of material files and scenes, and what results have");
  command
      ->add_option("OF", options->of,
                   "material; point, solve, dns or wave: of their scenes; columns, "
                   "balance, measures or statuses: of results")
      ->required();
  command->add_flag("--markdown", options->markdown, "as tables of a page");
  command->callback([options] {
    if (const std::string table = result_table(options->of); !table.empty()) {
      fmt::print("{}", table);
      return;
    }
    const std::vector<Key> keys =
        options->of == "material" ? material_keys() : scene_keys(options->of);
    options->markdown ? print_markdown(keys) : print_list(keys);
  });
}

}  // namespace verification
