#pragma once
/// Finds files by names written on another machine: with backslashes, different case or absent
/// folders.
///
/// Conventions: tries, in this order, the name itself (backslashes as slashes), the name ignoring
/// case, also that of folders, and, if so asked, its last component next to the scene file, also
/// ignoring case. Nothing outside `roots` is accessed. After kMaxNames different names the search
/// stops, which bounds the time of crafted name lists.

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace alhazen {

class PictureFinder {
  public:
    /// Whether a file in another folder than the one written counts.
    enum class Elsewhere { Refused, BesideTheScene };

    PictureFinder(std::vector<std::filesystem::path> roots, std::filesystem::path folder,
                  Elsewhere elsewhere = Elsewhere::Refused)
        : roots_(std::move(roots)), folder_(std::move(folder)), elsewhere_(elsewhere) {}

    static constexpr std::size_t kMaxNames = 10'000;
    /// Lower-case name -> names of the files and folders in a folder.
    using Listing = std::map<std::string, std::set<std::string>>;

    /// A name relative to the folder under which the file exists; none if there is no such file.
    [[nodiscard]] std::optional<std::string> find(const std::string& name);

  private:
    std::optional<std::string> search(const std::string& name);
    std::optional<std::string> exact(const std::string& name) const;
    std::optional<std::string> with_other_capitals(const std::string& name);
    const Listing& listing(const std::filesystem::path& folder);

    std::vector<std::filesystem::path> roots_;
    std::filesystem::path folder_;
    Elsewhere elsewhere_;
    std::map<std::string, std::optional<std::string>> found_;
    std::map<std::filesystem::path, Listing> listings_;  ///< of the folders visited
};

}  // namespace alhazen
