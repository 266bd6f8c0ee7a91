// SPDX-License-Identifier: Apache-2.0
// A TOML file as a tree of values that know their lines, and sections of it that refuse what they do not
// know.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace garrison::node {

struct TomlValue;
using TomlTable = std::map<std::string, TomlValue>;
using TomlArray = std::vector<TomlValue>;
/// A moment, in microseconds since 1970.
struct TomlMoment {
  std::int64_t micros = 0;
};
struct TomlValue {
  std::variant<bool, std::int64_t, double, std::string, TomlMoment, TomlArray, TomlTable> value;
  int line = 0;
};

/// One table. Errors say file, line, section and key, what was got, expected, and what to do.
class Section {
 public:
  Section(std::string file, std::string name, const TomlValue& table);

  /// Refuses every other key, with the nearest of these.
  void only(std::initializer_list<const char*> keys) const;
  void only(const std::vector<std::string>& keys) const;
  bool has(const std::string& key) const { return find(key) != nullptr; }
  bool has_section(const std::string& key) const;
  /// Without `otherwise` the key has to be there.
  std::string text(const std::string& key, std::optional<std::string> otherwise = {}) const;
  std::int64_t whole(const std::string& key, std::int64_t least, std::int64_t most,
                     std::optional<std::int64_t> otherwise = {}) const;
  double number(const std::string& key, double least, double most,
                std::optional<double> otherwise = {}) const;
  bool flag(const std::string& key, bool otherwise) const;
  std::vector<double> numbers(const std::string& key) const;  ///< empty where the key is not there
  /// Lists of numbers in a list, e.g. the rows of a matrix; numbers alone are one row each.
  std::vector<std::vector<double>> rows(const std::string& key) const;
  std::vector<std::string> texts(const std::string& key) const;  ///< the same
  std::int64_t moment(const std::string& key) const;
  /// An empty section where the key is not there.
  Section section(const std::string& key) const;
  std::vector<Section> sections(const std::string& key) const;
  /// "FILE, line 3, [sensor].kind"
  std::string where(const std::string& key) const;

 private:
  const TomlValue* find(const std::string& key) const;
  const TomlValue& need(const std::string& key, const std::string& expected) const;

  std::string file_;
  std::string name_;
  std::shared_ptr<const TomlValue> table_;
};

/// @throws IoError when it cannot be read, InvalidInput with the line when it is no TOML
Section read_toml(const std::string& path);
Section parse_toml(const std::string& text, const std::string& path);

}  // namespace garrison::node
