#pragma once
/// Errors of the library as Python exceptions, and locations in text that Python made.
///
/// Conventions: alhazen.Error and its subclasses by ErrorKind (alhazen/_errors.py), with the
/// members file, line and column.

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "alhazen/base/diagnostics.h"

namespace alhazen::python {

/// Lets exceptions of the library reach Python as alhazen.Error.
void translate_errors();

/// Where the lines of a text come from: [line - 1] the place of the statement that made it.
using Origins = std::vector<FileLocation>;

/// The findings with the places of `origins` where they are in the file `name`.
[[nodiscard]] Diagnostics at_origins(const Diagnostics& found, const std::string& name,
                                     const Origins& origins);

}  // namespace alhazen::python
