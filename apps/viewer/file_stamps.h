#pragma once
/// What files were before they were read, to notice every change since.
///
/// Source: the stamps of Git's index and its remedy against edits within the resolution of file
/// times ("racy git", Documentation/technical/racy-git.txt).
/// Differs: contents are compared for as long as a change might not show in time and size, not
/// later. Conventions: a file that is missing has a stamp too, and changes when it appears.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

namespace alhazen::viewer {

class FileStamps {
  public:
    using Time = std::int64_t;  ///< nanoseconds

    [[nodiscard]] static Time now();
    /// To be called before the files are read.
    void take(const std::set<std::filesystem::path>& files);
    /// Of files that turned out to be read after `began`: one that may have changed since counts as
    /// changed. Those that `take` knew are left as they are.
    void add(const std::set<std::filesystem::path>& files, Time began);
    /// Whether a file is not what it was.
    [[nodiscard]] bool changed();
    /// All files.
    [[nodiscard]] std::set<std::filesystem::path> files() const;

  private:
    struct Stamp {
        bool exists = false;
        bool suspect = false;  ///< it counts as changed
        Time written = 0;      ///< by the file system's clock
        Time touched = 0;      ///< the same, which programs cannot set back
        std::int64_t size = 0;
        std::uint64_t number = 0;  ///< another one where the file was replaced
        std::optional<std::uint64_t>
            content;  ///< where an edit may leave time and size as they are
    };
    [[nodiscard]] static Stamp stamp_of(const std::filesystem::path& file);

    std::map<std::filesystem::path, Stamp> stamps_;
};

}  // namespace alhazen::viewer
