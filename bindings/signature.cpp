// SPDX-License-Identifier: Apache-2.0
#include "signature.hpp"

#include <algorithm>
#include <set>

namespace {

using Kind = ArgumentType::Kind;

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && s.front() == ' ') s.remove_prefix(1);
  while (!s.empty() && s.back() == ' ') s.remove_suffix(1);
  return s;
}

/// Parts between `separator` that are in no bracket and no quotes; -> is no bracket.
std::vector<std::string_view> split(std::string_view s, char separator) {
  std::vector<std::string_view> parts;
  int depth = 0;
  char quote = 0;
  std::size_t begin = 0;
  for (std::size_t k = 0; k < s.size(); ++k) {
    const char c = s[k];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '\'' || c == '"') {
      quote = c;
    } else if (c == '(' || c == '[' || c == '{') {
      ++depth;
    } else if (c == ')' || c == ']' || c == '}') {
      --depth;
    } else if (c == separator && depth == 0) {
      parts.push_back(trimmed(s.substr(begin, k - begin)));
      begin = k + 1;
    }
  }
  const auto last = trimmed(s.substr(begin));
  if (!last.empty()) parts.push_back(last);
  return parts;
}

/// "list[X, Y]" -> {"list", "X, Y"}; without brackets the second one is empty.
std::pair<std::string_view, std::string_view> head_and_inside(std::string_view s) {
  const auto open = s.find('[');
  if (open == std::string_view::npos || s.back() != ']') return {s, {}};
  return {s.substr(0, open), s.substr(open + 1, s.size() - open - 2)};
}

/// The last name of a dotted one.
std::string_view base_name(std::string_view s) {
  const auto dot = s.rfind('.');
  return dot == std::string_view::npos ? s : s.substr(dot + 1);
}

ArgumentType array_type(std::string_view text) {
  if (text.find("numpy.int") != std::string_view::npos) return {Kind::wholes};
  if (text.find("[m, 1]") != std::string_view::npos) return {Kind::vector};
  if (text.find("[m, n]") != std::string_view::npos) return {Kind::matrix};
  return {Kind::array};
}

ArgumentType type_of(std::string_view text, const Classes& classes);

ArgumentType type_of_one(std::string_view text, const Classes& classes) {
  if (const auto found = classes.find(text); found != classes.end()) {
    ArgumentType type{Kind::instance};
    type.instance = found->second;
    return type;
  }
  const auto [head, inside] = head_and_inside(text);
  const auto name = base_name(head);
  if (name == "SupportsFloat" || name == "float") return {Kind::number};
  if (name == "SupportsInt" || name == "int") return {Kind::whole};
  if (name == "bool") return {Kind::flag};
  if (name == "str") return {Kind::text};
  if (name == "Annotated" || name == "ndarray" || name == "NDArray" || name == "ArrayLike")
    return array_type(text);
  if (name == "dict" || name == "Dict" || name == "Mapping") return {Kind::map};
  if (name == "Iterable") return {Kind::many};
  if (name == "Optional") {
    ArgumentType type = type_of(inside, classes);
    type.optional = true;
    return type;
  }
  if (name == "Sequence" || name == "list" || name == "List")
    return {Kind::list, false, {inside.empty() ? ArgumentType{} : type_of(inside, classes)}};
  if (name == "tuple" || name == "Tuple") {
    ArgumentType type{Kind::tuple};
    for (const auto part : split(inside, ',')) type.of.push_back(type_of(part, classes));
    return type;
  }
  return {Kind::anything};
}

/// "A | B | None": of several numbers the more general one.
ArgumentType type_of(std::string_view text, const Classes& classes) {
  ArgumentType type;
  bool first = true;
  bool none = false;
  for (const auto part : split(text, '|')) {
    if (part == "None") {
      none = true;
    } else if (first && base_name(part) != "SupportsIndex") {
      type = type_of_one(part, classes);
      first = false;
    }
  }
  type.optional = none || type.optional || type.kind == Kind::anything;
  return type;
}

}  // namespace

std::string ArgumentType::expected() const {
  const auto one = [&]() -> std::string {
    switch (kind) {
      case Kind::number:
        return "a number";
      case Kind::whole:
        return "a whole number";
      case Kind::flag:
        return "True or False";
      case Kind::text:
        return "a string";
      case Kind::array:
        return "an array of numbers";
      case Kind::matrix:
        return "a matrix of numbers (rows x columns)";
      case Kind::vector:
        return "a list of numbers";
      case Kind::wholes:
        return "a list of whole numbers";
      case Kind::list:
        return of.front().kind == Kind::anything ? "a list" : "a list, each entry " + of.front().expected();
      case Kind::tuple:
        return std::to_string(of.size()) + " values";
      case Kind::many:
        return "a list";
      case Kind::map:
        return "a dict";
      case Kind::instance:
        return "a " + instance.attr("__name__").cast<std::string>();
      case Kind::anything:
        break;
    }
    return "a value";
  };
  return one() + (optional && kind != Kind::anything ? ", or None" : "");
}

std::optional<std::vector<Argument>> parse_signature(std::string_view line, const Classes& classes) {
  const auto open = line.find('(');
  if (open == std::string_view::npos) return std::nullopt;
  const auto pieces = split(line.substr(open), '>');  // "(arguments) -" and the result
  auto inside = trimmed(pieces.empty() ? std::string_view() : pieces.front());
  if (inside.size() < 3 || inside.back() != '-') return std::nullopt;
  inside = trimmed(inside.substr(0, inside.size() - 1));
  inside = inside.substr(1, inside.size() - 2);
  std::vector<Argument> all;
  bool keyword_only = false;
  for (const auto part : split(inside, ',')) {
    if (part == "*") {
      keyword_only = true;
      continue;
    }
    if (part == "/") continue;
    if (part.starts_with('*')) return std::nullopt;
    const auto value = split(part, '=');
    const auto named = split(value.front(), ':');
    Argument argument;
    argument.name = named.front();
    argument.type = named.size() > 1 ? type_of(named[1], classes) : ArgumentType{Kind::anything, true};
    argument.required = value.size() == 1;
    argument.keyword_only = keyword_only;
    // pybind11 does not say that None is fine where it is the default
    if (!argument.required && value[1] == "None") argument.type.optional = true;
    all.push_back(std::move(argument));
  }
  return all;
}
