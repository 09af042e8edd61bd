#pragma once
/// Finds files by names that were written on another machine: with backslashes, with other
/// capitals, in folders that are not here.
///
/// Conventions: tried are, in this order, the name as it is (backslashes as slashes), the same
/// whatever its capitals, and its last part beside the scene file, also whatever its capitals.
/// Nothing outside of `roots` is looked at. After kMaxNames different names no more are looked for,
/// so that a list of made-up names does not take forever.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace alhazen {

class PictureFinder {
  public:
    PictureFinder(std::vector<std::filesystem::path> roots, std::filesystem::path folder)
        : roots_(std::move(roots)), folder_(std::move(folder)) {}

    static constexpr std::size_t kMaxNames = 10'000;

    /// A name relative to the folder under which the file exists, or nothing.
    [[nodiscard]] std::optional<std::string> find(const std::string& name);

  private:
    std::optional<std::string> search(const std::string& name);
    std::optional<std::string> exact(const std::string& name) const;
    std::optional<std::string> with_other_capitals(const std::string& name);

    std::vector<std::filesystem::path> roots_;
    std::filesystem::path folder_;
    std::map<std::string, std::optional<std::string>> found_;
    /// Lower-case name -> name of the files in a folder; folders that were looked at.
    std::map<std::filesystem::path, std::map<std::string, std::string>> listings_;
};

}  // namespace alhazen
