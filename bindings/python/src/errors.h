#pragma once
/// Errors of the library as Python exceptions, and locations in text that Python made.
///
/// Conventions: alhazen.Error and its subclasses by ErrorKind (alhazen/_errors.py), with the
/// members file, line and column.

#include <pybind11/pybind11.h>

#include <string>
#include <utility>
#include <vector>

#include "alhazen/base/diagnostics.h"

namespace alhazen::python {

/// Lets exceptions of the library reach Python as alhazen.Error.
void translate_errors();

/// Several findings: the message lists them, and the location is that of the first.
class FoundErrors final : public Error {
  public:
    FoundErrors(const Error& all, FileLocation first) : Error(all), first_(std::move(first)) {}
    [[nodiscard]] const FileLocation& first() const { return first_; }

  private:
    FileLocation first_;
};

/// Throws FoundErrors where `found` has errors.
void throw_found(const Diagnostics& found);

/// Where the lines of a text come from: [line - 1] the place of the statement that made it.
using Origins = std::vector<FileLocation>;

/// The findings with the places of `origins` where they are in the file `name`.
[[nodiscard]] Diagnostics at_origins(const Diagnostics& found, const std::string& name,
                                     const Origins& origins);

}  // namespace alhazen::python
