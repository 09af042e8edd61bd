#pragma once
/// Unique labels for formats that refer to objects by name.

#include <string>
#include <unordered_set>
#include <vector>

namespace alhazen {

/// One label per name: the name itself at its first occurrence, otherwise the name with an unused
/// number appended; `kind` replaces an empty name. Unique names are kept.
[[nodiscard]] inline std::vector<std::string> unique_labels(const std::vector<std::string>& names,
                                                            const std::string& kind) {
    std::unordered_set<std::string> taken;
    std::vector<std::string> labels(names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (!names[i].empty() && taken.insert(names[i]).second) labels[i] = names[i];
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (!labels[i].empty()) continue;
        const std::string stem = (names[i].empty() ? kind : names[i]) + "_";
        // With a stride of the number of names, labels of this loop cannot collide.
        for (std::size_t number = i; labels[i].empty(); number += names.size()) {
            const std::string label = stem + std::to_string(number);
            if (taken.insert(label).second) labels[i] = label;
        }
    }
    return labels;
}

}  // namespace alhazen
