#pragma once
/// The files that a conversion writes: OUT, and those beside it that OUT names.
///
/// Conventions: all is written under other names first and moved to its place in `finish`, OUT
/// last: a conversion that fails or is stopped leaves an earlier one as it was. What belongs to
/// another scene is not replaced: where a file of OUT_files/ has other bytes and a scene file
/// beside OUT names it, the new one gets another name. Without `finish`, files and folders that
/// were not there before are taken away again.

#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "alhazen/session/convert.h"

namespace alhazen {

class ConvertOutput {
  public:
    /// `suffix` is that of `path` in small letters.
    ConvertOutput(std::filesystem::path path, std::string suffix)
        : path_(std::move(path)), suffix_(std::move(suffix)) {}
    ~ConvertOutput();
    ConvertOutput(const ConvertOutput&) = delete;
    ConvertOutput& operator=(const ConvertOutput&) = delete;

    /// Relative to OUT: where the files that it names are.
    [[nodiscard]] std::string folder() const { return path_.stem().string() + "_files"; }
    [[nodiscard]] std::filesystem::path sibling(const char* suffix) const {
        return std::filesystem::path(path_.stem()).concat(suffix);
    }

    /// Throws Error (Usage) when one of `inputs` could be replaced: it is OUT or the file of its
    /// materials, or lies in the folder of its files.
    void check_inputs(const std::set<std::filesystem::path>& inputs) const;

    /// Writes a file of the folder. Returns its name relative to OUT: `name`, or another one.
    std::string write_beside(const std::string& name, std::span<const std::byte> bytes);
    /// Writes a file whose name is its own, beside OUT.
    void write_sibling(const std::filesystem::path& name, std::span<const std::byte> bytes);
    ConvertReport finish(std::span<const std::byte> bytes);
    ConvertReport& report() { return report_; }

  private:
    void make_folder(const std::filesystem::path& folder);
    /// What to call it so that no other scene loses a file.
    std::filesystem::path free_name(const std::filesystem::path& path,
                                    std::span<const std::byte> bytes);
    bool is_named_by_others(const std::string& file_name);
    /// Writes it under another name, to be moved.
    void stage(const std::filesystem::path& path, std::span<const std::byte> bytes);
    void move_staged();
    void count(const std::filesystem::path& path, std::size_t bytes);

    struct Staged {
        std::filesystem::path from, to;
        bool moved = false;
    };

    std::filesystem::path path_;
    std::string suffix_;
    ConvertReport report_;
    std::vector<Staged> staged_;
    std::vector<std::filesystem::path> made_;  ///< files that were not there before
    std::optional<std::filesystem::path> made_folder_;
    bool finished_ = false;
    /// Files of folders like ours that scene files beside OUT name; looked for when there is a
    /// reason.
    std::optional<std::set<std::string>> named_by_others_;
    bool may_name_anything_ = false;  ///< one of them cannot be read
};

}  // namespace alhazen
