// SPDX-License-Identifier: Apache-2.0
// Docstrings in numpydoc form, written in few lines.
#pragma once

#include <string>
#include <string_view>

/// The docstring of a text and, below an empty line, a line per item:
///
///   name : type | what it is    under Parameters
///   < type | what it is         under Returns
///   ! Error | when              under Raises
///
/// Lines that begin with two spaces go on with the item above.
std::string numpydoc(std::string_view compact);
