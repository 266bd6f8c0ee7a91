#!/usr/bin/env bash
# Every header compiles alone, without a warning under the strictest flags that we know users to have. $1: where
# garrison/ lies.
set -euo pipefail
cd "$1"
flags=(-std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Werror -I.)
read -ra eigen <<<"$(pkg-config --cflags-only-I eigen3)"
find garrison -name '*.hpp' | sort | xargs -P "$(nproc)" -I{} \
  "${CXX:-g++}" "${flags[@]}" "${eigen[@]/#-I/-isystem}" -x c++ -include {} /dev/null
echo "package: $(find garrison -name '*.hpp' | wc -l) headers compile alone"
if command -v clang++ >/dev/null; then  # for its warnings, once
  find garrison -name '*.hpp' | sort | sed 's/.*/#include "&"/' |
    clang++ "${flags[@]}" "${eigen[@]/#-I/-isystem}" -x c++ -
  echo "package: clang++ has no complaint about them"
else
  echo "package: clang++ left out, not installed"
fi
