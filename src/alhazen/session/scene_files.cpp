#include "alhazen/session/scene_files.h"

#include <system_error>

#include "alhazen/base/error.h"

namespace alhazen {

std::set<std::filesystem::path> files_of_scene(const SceneDescription& description) {
    std::set<std::filesystem::path> files = description.files;
    if (!description.path.empty()) files.insert(description.path);
    return files;
}

bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code failed;  // a file that does not exist differs from any other
    return std::filesystem::equivalent(a, b, failed) && !failed;
}

void check_spares_scene(const SceneDescription& description,
                        std::span<const std::filesystem::path> outputs) {
    for (const std::filesystem::path& input : files_of_scene(description)) {
        for (const std::filesystem::path& output : outputs) {
            if (!is_same_file(input, output)) continue;
            throw Error(ErrorKind::Usage, output.string() +
                                              " belongs to the scene that is read; expected "
                                              "another name for what is written");
        }
    }
}

}  // namespace alhazen
