#pragma once
/// Scene files of the test data, by expected result.

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "support/test_data.h"

namespace alhazen::testing {

/// All files below `folder` (of the test data) with this suffix, sorted by name.
inline std::vector<std::filesystem::path> files_below(const std::string& folder,
                                                      const std::string& suffix) {
    std::vector<std::filesystem::path> files;
    const std::filesystem::path root = test_data() / folder;
    if (!std::filesystem::exists(root)) return files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
        if (entry.is_regular_file() && entry.path().extension() == suffix)
            files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace alhazen::testing
