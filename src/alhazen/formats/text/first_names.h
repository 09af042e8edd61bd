#pragma once
/// Lists of defined names in messages, short whatever the file defines.

#include <string>

namespace alhazen {

/// The first 20 keys of `names`, a map by name, each cut at 60 bytes: "a, b, c, ...".
template <class Map>
[[nodiscard]] std::string first_names(const Map& names) {
    constexpr std::size_t kMostListed = 20, kLongest = 60;
    std::string text;
    std::size_t listed = 0;
    for (const auto& [name, value] : names) {
        if (listed != 0) text += ", ";
        if (listed++ == kMostListed) return text + "...";
        text += name.substr(0, kLongest);
    }
    return text;
}

}  // namespace alhazen
