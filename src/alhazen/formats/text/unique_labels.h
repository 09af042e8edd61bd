#pragma once
/// Names made unique, for formats whose things are referred to by name.

#include <string>
#include <unordered_set>
#include <vector>

namespace alhazen {

/// One label for each name: the name itself where it is the first of its kind, else with a number
/// that is free; `kind` stands for an empty one. Unique names are never changed.
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
        // Steps of the number of names: other labels of this loop cannot be in the way.
        for (std::size_t number = i; labels[i].empty(); number += names.size()) {
            const std::string label = stem + std::to_string(number);
            if (taken.insert(label).second) labels[i] = label;
        }
    }
    return labels;
}

}  // namespace alhazen
