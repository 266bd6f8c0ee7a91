// SPDX-License-Identifier: Apache-2.0
#include "numpydoc.hpp"

namespace {

struct Section {
  std::string_view mark;  ///< what its items begin with
  std::string title;
  std::string items{};
};

/// "name : type | text" -> the name in a line of its own, the text indented below it.
std::string item(std::string_view line) {
  const auto bar = line.find(" | ");
  std::string text(line.substr(0, bar));
  if (bar != std::string_view::npos) text.append("\n    ").append(line.substr(bar + 3));
  return text + "\n";
}

}  // namespace

std::string numpydoc(std::string_view compact) {
  const auto gap = compact.find("\n\n");
  std::string doc(compact.substr(0, gap));
  if (gap == std::string_view::npos) return doc;
  Section sections[] = {{"< ", "Returns"}, {"! ", "Raises"}, {"", "Parameters"}};
  Section* current = nullptr;
  for (auto rest = compact.substr(gap + 2); !rest.empty();) {
    const auto end = rest.find('\n');
    const auto line = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    if (line.starts_with("  ") && current != nullptr) {
      current->items.append("    ").append(line.substr(2)).append("\n");
      continue;
    }
    for (Section& section : sections) {
      if (!line.starts_with(section.mark)) continue;
      current = &section;
      break;
    }
    current->items += item(line.substr(current->mark.size()));
  }
  for (const std::size_t k : {2U, 0U, 1U})
    if (const Section& s = sections[k]; !s.items.empty())
      doc += "\n\n" + s.title + "\n" + std::string(s.title.size(), '-') + "\n" +
             s.items.substr(0, s.items.size() - 1);
  return doc;
}
