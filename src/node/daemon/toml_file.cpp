// SPDX-License-Identifier: Apache-2.0
#include "node/daemon/toml_file.hpp"

#include <chrono>
#include <cmath>
#include <exception>

namespace {
struct BrokenAssertion : std::exception {};
}  // namespace
// Some texts break an assertion inside of toml++ 3.3. Where assertions are off it is undefined what follows,
// so they are on here, and refuse the text.
#undef NDEBUG
#define TOML_ASSERT(condition) ((condition) ? void() : throw BrokenAssertion())
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wterminate"  // in functions that a parser never calls
#include <toml++/toml.h>
#pragma GCC diagnostic pop

#include "garrison/core/error.hpp"
#include "garrison/core/params.hpp"
#include "node/daemon/files.hpp"

namespace garrison::node {

namespace {

std::int64_t micros_of(const toml::date_time& given) {
  using namespace std::chrono;
  const year_month_day day{year{given.date.year}, month{given.date.month}, std::chrono::day{given.date.day}};
  const auto minutes_east = given.offset ? given.offset->minutes : std::int16_t{0};
  const auto time = hours{given.time.hour} + minutes{given.time.minute - minutes_east} +
                    seconds{given.time.second} + microseconds{given.time.nanosecond / 1000};
  return duration_cast<microseconds>(sys_days{day}.time_since_epoch() + time).count();
}

TomlValue value_of(const toml::node& node) {
  TomlValue out;
  out.line = static_cast<int>(node.source().begin.line);
  if (const auto* table = node.as_table()) {
    TomlTable all;
    for (const auto& [key, value] : *table) all.emplace(std::string(key.str()), value_of(value));
    out.value = std::move(all);
  } else if (const auto* array = node.as_array()) {
    TomlArray all;
    for (const auto& value : *array) all.push_back(value_of(value));
    out.value = std::move(all);
  } else if (const auto* text = node.as_string()) {
    out.value = text->get();
  } else if (const auto* whole = node.as_integer()) {
    out.value = whole->get();
  } else if (const auto* number = node.as_floating_point()) {
    out.value = number->get();
  } else if (const auto* flag = node.as_boolean()) {
    out.value = flag->get();
  } else if (const auto* moment = node.as_date_time()) {
    out.value = TomlMoment{micros_of(moment->get())};
  } else {
    out.value = std::string("a date or time without the other");
  }
  return out;
}

std::string shown(const TomlValue& given) {
  if (const auto* text = std::get_if<std::string>(&given.value)) return "\"" + text->substr(0, 60) + "\"";
  if (const auto* whole = std::get_if<std::int64_t>(&given.value)) return std::to_string(*whole);
  if (const auto* number = std::get_if<double>(&given.value)) return text(*number);
  if (const auto* flag = std::get_if<bool>(&given.value)) return *flag ? "true" : "false";
  if (std::holds_alternative<TomlMoment>(given.value)) return "a time";
  return std::holds_alternative<TomlArray>(given.value) ? "a list" : "a table";
}

std::optional<double> as_number(const TomlValue& given) {
  if (const auto* whole = std::get_if<std::int64_t>(&given.value)) return static_cast<double>(*whole);
  if (const auto* number = std::get_if<double>(&given.value)) return *number;
  return {};
}

}  // namespace

Section parse_toml(const std::string& text, const std::string& path) {
  try {
    return {path, "", value_of(toml::parse(text, path))};
  } catch (const toml::parse_error& error) {
    refuse(path + ", line " + std::to_string(error.source().begin.line), std::string(error.description()),
           "a TOML document");
  } catch (const BrokenAssertion&) {
    refuse(path, "a key or value that begins with a character that none begins with", "a TOML document");
  }
}

Section read_toml(const std::string& path) { return parse_toml(read_text(path), path); }

Section::Section(std::string file, std::string name, const TomlValue& table)
    : file_(std::move(file)), name_(std::move(name)), table_(std::make_shared<const TomlValue>(table)) {
  if (!std::holds_alternative<TomlTable>(table.value))
    refuse(file_ + ", line " + std::to_string(table.line) + ", " + name_, shown(table), "a table",
           "write it as [" + name_ + "]");
}

const TomlValue* Section::find(const std::string& key) const {
  const auto& table = std::get<TomlTable>(table_->value);
  const auto at = table.find(key);
  return at == table.end() ? nullptr : &at->second;
}
const TomlValue& Section::need(const std::string& key, const std::string& expected) const {
  const TomlValue* found = find(key);
  if (found == nullptr) refuse(where(key), "nothing", expected, "add a line \"" + key + " = ...\"");
  return *found;
}

std::string Section::where(const std::string& key) const {
  const TomlValue* found = find(key);
  const int line = found != nullptr ? found->line : table_->line;
  const std::string full = name_.empty() ? key : "[" + name_ + "]." + key;
  return file_ + ", line " + std::to_string(line) + ", " + full;
}

void Section::only(std::initializer_list<const char*> keys) const {
  const std::vector<std::string> known(keys.begin(), keys.end());
  for (const auto& [key, value] : std::get<TomlTable>(table_->value)) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    std::string list;
    for (const std::string& one : known) list += (list.empty() ? "" : ", ") + one;
    const std::string near = nearest_name(key, known);
    refuse(where(key), "an unknown key", "one of " + list,
           near.empty() ? "" : "did you mean \"" + near + "\"?");
  }
}

std::string Section::text(const std::string& key, std::optional<std::string> otherwise) const {
  if (otherwise && !has(key)) return *otherwise;
  const TomlValue& found = need(key, "a text");
  if (const auto* text = std::get_if<std::string>(&found.value)) return *text;
  refuse(where(key), shown(found), "a text", "put it in quotes");
}

std::int64_t Section::whole(const std::string& key, std::int64_t least, std::int64_t most,
                            std::optional<std::int64_t> otherwise) const {
  if (otherwise && !has(key)) return *otherwise;
  const std::string expected = "a whole number in " + std::to_string(least) + ".." + std::to_string(most);
  const TomlValue& found = need(key, expected);
  const auto* whole = std::get_if<std::int64_t>(&found.value);
  if (whole == nullptr || *whole < least || *whole > most) refuse(where(key), shown(found), expected);
  return *whole;
}

double Section::number(const std::string& key, double least, double most,
                       std::optional<double> otherwise) const {
  if (otherwise && !has(key)) return *otherwise;
  const std::string expected = "a number in " + garrison::text(least) + ".." + garrison::text(most);
  const TomlValue& found = need(key, expected);
  const auto number = as_number(found);
  if (!number || !(*number >= least && *number <= most)) refuse(where(key), shown(found), expected);
  return *number;
}

bool Section::flag(const std::string& key, bool otherwise) const {
  const TomlValue* found = find(key);
  if (found == nullptr) return otherwise;
  if (const auto* flag = std::get_if<bool>(&found->value)) return *flag;
  refuse(where(key), shown(*found), "true or false");
}

std::vector<double> Section::numbers(const std::string& key) const {
  const TomlValue* found = find(key);
  if (found == nullptr) return {};
  const auto* list = std::get_if<TomlArray>(&found->value);
  if (list == nullptr) refuse(where(key), shown(*found), "a list of numbers");
  std::vector<double> out;
  for (const TomlValue& one : *list) {
    const auto number = as_number(one);
    if (!number || !std::isfinite(*number)) refuse(where(key), shown(one), "finite numbers");
    out.push_back(*number);
  }
  return out;
}

std::vector<std::string> Section::texts(const std::string& key) const {
  const TomlValue* found = find(key);
  if (found == nullptr) return {};
  const auto* list = std::get_if<TomlArray>(&found->value);
  if (list == nullptr) refuse(where(key), shown(*found), "a list of texts");
  std::vector<std::string> out;
  for (const TomlValue& one : *list) {
    const auto* text = std::get_if<std::string>(&one.value);
    if (text == nullptr) refuse(where(key), shown(one), "texts");
    out.push_back(*text);
  }
  return out;
}

std::int64_t Section::moment(const std::string& key) const {
  const TomlValue& found = need(key, "a time, e.g. 2026-01-31T12:00:00Z");
  if (const auto* moment = std::get_if<TomlMoment>(&found.value)) return moment->micros;
  if (const auto* whole = std::get_if<std::int64_t>(&found.value)) return *whole;
  refuse(where(key), shown(found), "a time, e.g. 2026-01-31T12:00:00Z, or microseconds since 1970");
}

Section Section::section(const std::string& key) const {
  const TomlValue* found = find(key);
  if (found == nullptr) return {file_, key, {TomlTable{}, table_->line}};
  return {file_, key, *found};
}

std::vector<Section> Section::sections(const std::string& key) const {
  const TomlValue& found = need(key, "tables [[" + key + "]]");
  const auto* list = std::get_if<TomlArray>(&found.value);
  if (list == nullptr) refuse(where(key), shown(found), "tables [[" + key + "]]");
  std::vector<Section> out;
  for (const TomlValue& one : *list) out.emplace_back(file_, key, one);
  return out;
}

}  // namespace garrison::node
