#pragma once
/// Messages on standard error and standard output.
///
/// Writing may fail (a full disk, a closed pipe): messages are then lost, and the program
/// continues. Losses on standard output are detected at the end of the program. Control characters,
/// which file names may contain, are escaped; newlines are not.

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>

#include "alhazen/base/control_characters.h"

namespace alhazen::cli {

/// "1 triangle", "2 triangles".
[[nodiscard]] inline std::string counted(std::uint64_t count, const char* one) {
    return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
}

template <class... Args>
void print_to(std::FILE* stream, fmt::format_string<Args...> format, Args&&... args) {
    const std::string text =
        escape_controls(fmt::format(format, std::forward<Args>(args)...), Newlines::Keep);
    (void)std::fwrite(text.data(), 1, text.size(), stream);
}
/// Prints to standard error.
template <class... Args>
void tell(fmt::format_string<Args...> format, Args&&... args) {
    print_to(stderr, format, std::forward<Args>(args)...);
}
/// Prints to standard output.
template <class... Args>
void print(fmt::format_string<Args...> format, Args&&... args) {
    print_to(stdout, format, std::forward<Args>(args)...);
}

}  // namespace alhazen::cli
