// SPDX-License-Identifier: Apache-2.0
// JSON as it is written here: objects and lists by hand, numbers so that they are read back the same.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "garrison/core/error.hpp"

namespace garrison::node {

class Json {
 public:
  Json& open(char bracket) { return before().raw(bracket).fresh(); }
  Json& close(char bracket) {
    first_ = false;
    return raw(bracket);
  }
  Json& key(std::string_view name) {
    before().quoted(name).raw(':');
    return fresh();
  }
  Json& number(double value) { return before().add(std::isfinite(value) ? text(value) : "null"); }
  Json& whole(std::int64_t value) { return before().add(std::to_string(value)); }
  Json& flag(bool value) { return before().add(value ? "true" : "false"); }
  Json& word(std::string_view text) { return before().quoted(text); }
  std::string take() { return std::move(out_); }

 private:
  Json& before() {
    if (!first_) out_ += ',';
    first_ = false;
    return *this;
  }
  Json& fresh() {
    first_ = true;
    return *this;
  }
  Json& raw(char c) {
    out_ += c;
    return *this;
  }
  Json& add(std::string_view text) {
    out_ += text;
    return *this;
  }
  Json& quoted(std::string_view text) {
    out_ += '"';
    for (const char c : text) {
      std::array<char, 8> escaped{};
      if (c == '"' || c == '\\')
        (out_ += '\\') += c;
      else if (static_cast<unsigned char>(c) < 0x20)
        out_.append(escaped.data(),
                    static_cast<std::size_t>(std::snprintf(escaped.data(), escaped.size(), "\\u%04x", c)));
      else
        out_ += c;
    }
    out_ += '"';
    return *this;
  }

  std::string out_;
  bool first_ = true;
};

}  // namespace garrison::node
