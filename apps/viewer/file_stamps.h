#pragma once
/// Detects changes of files since before they were read.
///
/// Source: the stamps of Git's index and its remedy against edits within the resolution of file
/// times ("racy git", Documentation/technical/racy-git.txt).
/// Differs: contents are compared only as long as an edit may leave time and size unchanged.
/// Conventions: a missing file has a stamp too, and changes when it appears.

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
    /// Records the files. Call before reading them.
    void take(const std::set<std::filesystem::path>& files);
    /// Adds files found to be read after `began`: those that may have changed since count as
    /// changed. Files that `take` recorded are unchanged.
    void add(const std::set<std::filesystem::path>& files, Time began);
    /// True if a file differs from its stamp.
    [[nodiscard]] bool changed();
    /// All recorded files.
    [[nodiscard]] std::set<std::filesystem::path> files() const;

  private:
    struct Stamp {
        bool exists = false;
        bool suspect = false;  ///< counts as changed
        Time written = 0;      ///< modification time, by the file system's clock
        Time touched = 0;      ///< status change time, which programs cannot set back
        std::int64_t size = 0;
        std::uint64_t number = 0;  ///< inode; differs if the file was replaced
        /// Hash, if an edit may leave time and size unchanged.
        std::optional<std::uint64_t> content;
    };
    [[nodiscard]] static Stamp stamp_of(const std::filesystem::path& file);

    std::map<std::filesystem::path, Stamp> stamps_;
};

}  // namespace alhazen::viewer
