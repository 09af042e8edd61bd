#pragma once
/// Output files of a conversion: OUT, and the files beside it that OUT names.
///
/// Conventions: all files are written under temporary names and moved to their places in `finish`,
/// OUT last: a failed or stopped conversion leaves an earlier one intact. Files of other scenes are
/// not replaced: if a scene file beside OUT names a file of OUT_files/ whose bytes differ, the new
/// file gets another name. Without `finish`, new files and folders are removed.

#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "alhazen/session/conversion/convert.h"

namespace alhazen {

class ConvertOutput {
  public:
    /// `suffix`: that of `path`, in lower case.
    ConvertOutput(std::filesystem::path path, std::string suffix)
        : path_(std::move(path)), suffix_(std::move(suffix)) {}
    ~ConvertOutput();
    ConvertOutput(const ConvertOutput&) = delete;
    ConvertOutput& operator=(const ConvertOutput&) = delete;

    /// The folder of the files that OUT names, relative to OUT.
    [[nodiscard]] std::string folder() const { return path_.stem().string() + "_files"; }
    [[nodiscard]] std::filesystem::path sibling(const char* suffix) const {
        return std::filesystem::path(path_.stem()).concat(suffix);
    }

    /// Throws Error (Usage) when one of `inputs` could be replaced: it is OUT or its material file,
    /// or lies in its folder.
    void check_inputs(const std::set<std::filesystem::path>& inputs) const;

    /// Writes a file to the folder. Returns its name relative to OUT: `name`, or a free one.
    std::string write_beside(const std::string& name, std::span<const std::byte> bytes);
    /// Writes a file of a fixed name beside OUT.
    void write_sibling(const std::filesystem::path& name, std::span<const std::byte> bytes);
    ConvertReport finish(std::span<const std::byte> bytes);
    ConvertReport& report() { return report_; }

  private:
    void make_folder(const std::filesystem::path& folder);
    /// A file name that overwrites no file of another scene.
    std::filesystem::path free_name(const std::filesystem::path& path,
                                    std::span<const std::byte> bytes);
    bool is_named_by_others(const std::string& file_name);
    /// Writes the file under a temporary name.
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
    std::vector<std::filesystem::path> made_;  ///< files that did not exist before
    std::optional<std::filesystem::path> made_folder_;
    bool finished_ = false;
    /// Files in folders of conversions that scene files beside OUT name; searched on demand.
    std::optional<std::set<std::string>> named_by_others_;
    bool may_name_anything_ = false;  ///< one of these scene files cannot be read
};

}  // namespace alhazen
