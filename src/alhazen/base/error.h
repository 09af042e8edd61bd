#pragma once
/// The exception type of the library, with the location in a file that it refers to.
///
/// Cold code (loading, building, writing) throws `Error`; kernels never do. The message says what
/// was found and what was expected; control characters except the newline are escaped. The kind
/// decides the exit status of the command line.

#include <stdexcept>
#include <string>
#include <utility>

namespace alhazen {

/// A place in a text file. `line` and `column` count from 1; 0 means "not known".
struct FileLocation {
    std::string file;
    int line = 0;
    int column = 0;

    friend bool operator==(const FileLocation&, const FileLocation&) = default;
};

/// `file:line:column` without the parts that are unknown; empty for an empty location.
[[nodiscard]] std::string to_string(const FileLocation& location);

/// The class of an error, by what the user can do about it.
enum class ErrorKind {
    Render,    ///< a check did not hold or the render failed
    Usage,     ///< the call or the command line is wrong (unknown name, bad option)
    Scene,     ///< the scene or its data is bad
    File,      ///< a file could not be read or written
    Resource,  ///< memory, a count, a depth or a limit was exceeded
};

class Error : public std::runtime_error {
  public:
    Error(ErrorKind kind, const std::string& message, FileLocation location = {});

    [[nodiscard]] ErrorKind kind() const { return kind_; }
    [[nodiscard]] const FileLocation& location() const { return location_; }

  private:
    ErrorKind kind_;
    FileLocation location_;
};

}  // namespace alhazen
