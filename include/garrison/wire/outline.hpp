// SPDX-License-Identifier: Apache-2.0
// What is in an object that lists its parts (wire/archive.hpp), as lines for people.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "garrison/core/error.hpp"
#include "garrison/wire/archive.hpp"

namespace garrison::wire {

/// Threads: one at a time.
class Outline {
 public:
  explicit Outline(std::vector<std::string>& lines) : lines_(lines) {}

  template <class T>
  void operator()(std::string_view name, T&& x) {
    if constexpr (!detail::Dense<std::remove_cvref_t<T>> && requires { x.visit(*this); }) {
      Outline inner(lines_);
      inner.path_ = path_ + std::string(name) + ".";
      x.visit(inner);
    } else {
      lines_.push_back(path_ + std::string(name) + ": " + words(x));
    }
  }
  template <class T>
  void range(std::string_view name, T& x, std::int64_t, std::int64_t) {
    (*this)(name, x);
  }
  template <class E>
  void choice(std::string_view name, E& e, int) {
    lines_.push_back(path_ + std::string(name) + ": choice " + std::to_string(static_cast<int>(e)));
  }

 private:
  template <class T>
  static std::string words(const T& x) {
    if constexpr (std::is_same_v<T, bool>)
      return x ? "yes" : "no";
    else if constexpr (std::is_integral_v<T>)
      return std::to_string(x);
    else if constexpr (std::is_floating_point_v<T>)
      return text(x);
    else if constexpr (detail::Dense<T>)
      return std::to_string(x.rows()) + " x " + std::to_string(x.cols()) + " numbers";
    else if constexpr (requires { x.size(); })
      return "list of " + std::to_string(x.size());
    else
      return "numbers";
  }

  std::vector<std::string>& lines_;
  std::string path_;
};

template <class T>
std::vector<std::string> outline(const T& x) {
  std::vector<std::string> lines;
  Outline outline(lines);
  const_cast<T&>(x).visit(outline);  // only read
  return lines;
}

}  // namespace garrison::wire
