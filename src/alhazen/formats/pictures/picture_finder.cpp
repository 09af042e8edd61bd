#include "alhazen/formats/pictures/picture_finder.h"

#include <algorithm>

#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/base/lower_case.h"

namespace alhazen {

namespace {

constexpr std::size_t kMaxListed = 100'000;

PictureFinder::Listing list(const std::filesystem::path& folder) {
    PictureFinder::Listing names;
    std::size_t listed = 0;
    std::error_code failed;
    for (std::filesystem::directory_iterator entry(folder, failed), end; !failed && entry != end;
         entry.increment(failed)) {
        if (++listed > kMaxListed) break;
        std::string name = entry->path().filename().string();
        names[lower_case(name)].insert(std::move(name));
    }
    return names;
}

/// The folder that two absolute paths have in common.
std::filesystem::path common_folder(const std::filesystem::path& a,
                                    const std::filesystem::path& b) {
    std::filesystem::path common;
    const auto end = std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first;
    for (auto component = a.begin(); component != end; ++component) common /= *component;
    return common;
}

}  // namespace

std::optional<std::string> PictureFinder::exact(const std::string& name) const {
    try {
        const std::filesystem::path path = resolve_inside(roots_, folder_, name);
        std::error_code failed;
        if (std::filesystem::is_regular_file(path, failed)) return name;
    } catch (const Error&) {
        // Outside the allowed folders: treated as absent.
    }
    return std::nullopt;
}

const PictureFinder::Listing& PictureFinder::listing(const std::filesystem::path& folder) {
    static const Listing kNone;
    const auto known = listings_.find(folder);
    if (known != listings_.end()) return known->second;
    if (listings_.size() == kMaxNames) return kNone;
    Listing& names = listings_[folder];
    try {
        names = list(resolve_inside(roots_, folder_, folder.string()));
    } catch (const Error&) {
        // Outside the allowed folders: treated as empty.
    }
    return names;
}

std::optional<std::string> PictureFinder::with_other_capitals(const std::string& name) {
    const std::filesystem::path whole = (folder_ / name).lexically_normal();
    std::vector<std::filesystem::path> starts{common_folder(folder_, whole)};
    for (const std::filesystem::path& root : roots_) {
        if (root != starts.front()) starts.push_back(root);
    }
    for (const std::filesystem::path& start : starts) {
        std::vector<std::filesystem::path> places{start};
        for (const std::filesystem::path& component : whole.lexically_relative(start)) {
            const std::string wanted = lower_case(component.string());
            std::vector<std::filesystem::path> next;
            for (const std::filesystem::path& place : places) {
                const Listing& names = listing(place);
                const auto found = names.find(wanted);
                if (found == names.end()) continue;
                for (const std::string& found_name : found->second) {
                    next.push_back(place / found_name);
                }
            }
            places = std::move(next);
            if (places.empty()) break;
        }
        for (const std::filesystem::path& place : places) {
            if (auto found = exact(place.lexically_relative(folder_).string())) return found;
        }
    }
    return std::nullopt;
}

std::optional<std::string> PictureFinder::find(const std::string& written) {
    const auto known = found_.find(written);
    if (known != found_.end()) return known->second;
    if (found_.size() == kMaxNames) return std::nullopt;
    return found_[written] = search(written);
}

std::optional<std::string> PictureFinder::search(const std::string& written) {
    std::string name = written;
    std::replace(name.begin(), name.end(), '\\', '/');
    const std::string last = name.substr(name.rfind('/') + 1);
    for (const std::string& candidate : {name, last}) {
        if (candidate.empty()) continue;
        if (auto found = exact(candidate)) return found;
        if (auto found = with_other_capitals(candidate)) return found;
        if (elsewhere_ == Elsewhere::Refused) break;
    }
    return std::nullopt;
}

}  // namespace alhazen
