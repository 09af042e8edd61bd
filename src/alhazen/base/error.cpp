#include "alhazen/base/error.h"

#include "alhazen/base/control_characters.h"

namespace alhazen {

std::string to_string(const FileLocation& location) {
    std::string text = location.file;
    if (location.line > 0) {
        text += ":" + std::to_string(location.line);
        if (location.column > 0) text += ":" + std::to_string(location.column);
    }
    return text;
}

namespace {
std::string with_location(const std::string& message, const FileLocation& location) {
    const std::string place = to_string(location);
    // what() ends at a NUL; control characters in names from files would control a terminal.
    return escape_controls(place.empty() ? message : place + ": " + message, Newlines::Keep);
}
}  // namespace

Error::Error(ErrorKind kind, const std::string& message, FileLocation location)
    : std::runtime_error(with_location(message, location)),
      kind_(kind),
      location_(std::move(location)) {}

}  // namespace alhazen
