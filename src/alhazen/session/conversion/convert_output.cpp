#include "alhazen/session/conversion/convert_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <system_error>

#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/base/lower_case.h"
#include "alhazen/session/scene_files.h"

namespace alhazen {

namespace {

namespace fs = std::filesystem;

/// Larger scene files are not searched: they are assumed to name any file.
constexpr std::uint64_t kMaxSceneText = std::uint64_t{64} << 20;

bool is_scene_text(const fs::path& path) {
    static constexpr std::array<std::string_view, 6> kTextSuffixes{".alhazen", ".mtl", ".gltf",
                                                                   ".yaml",    ".yml", ".ray"};
    const std::string suffix = lower_suffix(path);
    return std::find(kTextSuffixes.begin(), kTextSuffixes.end(), suffix) != kTextSuffixes.end();
}

/// Adds the names after each "_files/" of a text, if a conversion can create them.
void add_names(std::string_view text, std::set<std::string>& names) {
    constexpr std::string_view kFolder = "_files";
    for (std::size_t at = text.find(kFolder); at != std::string_view::npos;
         at = text.find(kFolder, at)) {
        at += kFolder.size();
        const std::size_t begin = std::min(text.find_first_not_of("/\\", at), text.size());
        if (begin == at) continue;
        std::size_t end = begin;
        while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) != 0 ||
                                     text[end] == '_' || text[end] == '.')) {
            ++end;
        }
        names.emplace(text.substr(begin, end - begin));
        at = end;
    }
}

bool holds_bytes(const fs::path& path, std::span<const std::byte> bytes) {
    std::error_code failed;
    if (fs::file_size(path, failed) != bytes.size() || failed) return false;
    const std::string old = read_file(path, bytes.size());
    return std::ranges::equal(std::as_bytes(std::span(old)), bytes);
}

}  // namespace

ConvertOutput::~ConvertOutput() {
    if (finished_) return;
    std::error_code ignored;
    for (const Staged& file : staged_) {
        if (!file.moved) fs::remove(file.from, ignored);
    }
    for (const fs::path& file : made_) fs::remove(file, ignored);
    if (made_folder_) fs::remove(*made_folder_, ignored);  // only when it is empty
}

void ConvertOutput::check_inputs(const std::set<fs::path>& inputs) const {
    std::vector<fs::path> written{path_};
    if (suffix_ == ".obj") written.push_back(path_.parent_path() / sibling(".mtl"));
    const bool has_folder = suffix_ == ".obj" || suffix_ == ".alhazen";
    const fs::path files = path_.parent_path() / folder();
    for (const fs::path& input : inputs) {
        std::error_code failed;
        const fs::path target = fs::canonical(input, failed);
        const bool replaced = std::any_of(written.begin(), written.end(),
                                          [&](const auto& w) { return is_same_file(w, input); });
        const bool inside = has_folder && (is_same_file(fs::absolute(input).parent_path(), files) ||
                                           is_same_file(target.parent_path(), files));
        if (!replaced && !inside) continue;
        throw Error(ErrorKind::Usage,
                    fmt::format("{} belongs to the scene that is read and could be overwritten; "
                                "expected another name for {}",
                                input.string(), path_.string()));
    }
}

std::string ConvertOutput::write_beside(const std::string& name, std::span<const std::byte> bytes) {
    const fs::path path = path_.parent_path() / name;
    make_folder(path.parent_path());
    const fs::path free = free_name(path, bytes);
    stage(free, bytes);
    return (fs::path(name).parent_path() / free.filename()).string();
}

void ConvertOutput::write_sibling(const fs::path& name, std::span<const std::byte> bytes) {
    stage(path_.parent_path() / name, bytes);
}

ConvertReport ConvertOutput::finish(std::span<const std::byte> bytes) {
    if (fs::exists(path_) && !fs::is_regular_file(path_)) {
        throw Error(ErrorKind::File, "exists and is not a regular file", {path_.string(), 0, 0});
    }
    // Checks the disk space for OUT before anything is replaced; it is rewritten for its
    // permissions and links.
    fs::path room = path_;
    room += ".new";
    staged_.push_back({room, path_, false});
    write_file_atomically(room, bytes);
    fs::remove(room);
    staged_.pop_back();
    move_staged();
    write_file_atomically(path_, bytes);
    count(path_, bytes.size());
    finished_ = true;
    return std::move(report_);
}

void ConvertOutput::make_folder(const fs::path& folder) {
    std::error_code failed;
    if (fs::create_directory(folder, failed)) made_folder_ = folder;
    if (failed || !fs::is_directory(folder)) {
        throw Error(ErrorKind::File, "cannot make the folder: " + failed.message(),
                    {folder.string(), 0, 0});
    }
}

fs::path ConvertOutput::free_name(const fs::path& path, std::span<const std::byte> bytes) {
    fs::path candidate = path;
    // Each round skips an existing file, of which there are finitely many.
    for (int number = 2;; ++number) {
        std::error_code failed;
        const fs::file_status status = fs::symlink_status(candidate, failed);
        if (!fs::exists(status)) return candidate;
        const bool replaceable =
            fs::is_regular_file(status) &&
            (!is_named_by_others(candidate.filename().string()) || holds_bytes(candidate, bytes));
        if (replaceable) return candidate;
        candidate = path;
        candidate.replace_filename(
            fmt::format("{}_v{}{}", path.stem().string(), number, path.extension().string()));
    }
}

bool ConvertOutput::is_named_by_others(const std::string& file_name) {
    if (!named_by_others_) {
        named_by_others_.emplace();
        const fs::path beside = path_.has_parent_path() ? path_.parent_path() : fs::path(".");
        std::error_code failed;
        for (const auto& entry : fs::directory_iterator(beside, failed)) {
            std::error_code no_file;
            if (!is_scene_text(entry.path()) || !entry.is_regular_file(no_file)) continue;
            // The file about to be replaced does not count.
            if (is_same_file(entry.path(), path_)) continue;
            if (suffix_ == ".obj" && is_same_file(entry.path(), beside / sibling(".mtl"))) continue;
            try {
                add_names(read_file(entry.path(), kMaxSceneText), *named_by_others_);
            } catch (const Error&) {
                may_name_anything_ = true;
            }
        }
    }
    return may_name_anything_ || named_by_others_->contains(file_name);
}

void ConvertOutput::stage(const fs::path& path, std::span<const std::byte> bytes) {
    fs::path from = path;
    from += ".new";
    write_file_atomically(from, bytes);
    staged_.push_back({from, path});
    count(path, bytes.size());
}

void ConvertOutput::move_staged() {
    for (const Staged& file : staged_) {
        if (fs::is_directory(file.to)) {
            throw Error(ErrorKind::File, "is a folder", {file.to.string(), 0, 0});
        }
    }
    for (Staged& file : staged_) {
        std::error_code failed;
        const bool fresh = !fs::exists(fs::symlink_status(file.to, failed));
        fs::rename(file.from, file.to, failed);
        if (failed) {
            throw Error(ErrorKind::File, "cannot be replaced: " + failed.message(),
                        {file.to.string(), 0, 0});
        }
        file.moved = true;
        if (fresh) made_.push_back(file.to);
    }
}

void ConvertOutput::count(const fs::path& path, std::size_t bytes) {
    report_.files.push_back(path);
    report_.bytes += bytes;
}

}  // namespace alhazen
