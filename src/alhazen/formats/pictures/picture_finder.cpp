#include "alhazen/formats/pictures/picture_finder.h"

#include <algorithm>
#include <cctype>

#include "alhazen/base/error.h"
#include "alhazen/base/file.h"

namespace alhazen {

namespace {

constexpr std::size_t kMaxListed = 100'000;

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

std::map<std::string, std::string> list(const std::filesystem::path& folder) {
    std::map<std::string, std::string> names;
    std::error_code failed;
    for (std::filesystem::directory_iterator entry(folder, failed), end; !failed && entry != end;
         entry.increment(failed)) {
        if (names.size() == kMaxListed) break;
        std::string name = entry->path().filename().string();
        names.emplace(lower(name), std::move(name));
    }
    return names;
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

std::optional<std::string> PictureFinder::with_other_capitals(const std::string& name) {
    const std::filesystem::path relative(name);
    const std::filesystem::path parent = relative.parent_path();
    std::filesystem::path folder = folder_;
    try {
        if (!parent.empty()) folder = resolve_inside(roots_, folder_, parent.string());
    } catch (const Error&) {
        return std::nullopt;
    }
    const auto [entry, fresh] = listings_.try_emplace(folder);
    if (fresh) entry->second = list(folder);
    const auto found = entry->second.find(lower(relative.filename().string()));
    if (found == entry->second.end()) return std::nullopt;
    return exact((parent / found->second).string());
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
