#pragma once
/// Findings of reading and validating a scene, reported together.
///
/// Importers and validation add findings and continue where they can; `throw_if_errors` ends the
/// phase.

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "alhazen/base/error.h"

namespace alhazen {

enum class Severity { Warning, Error };

struct Diagnostic {
    Severity severity = Severity::Error;
    FileLocation location;
    std::string message;
};

/// `file:line:column: error: message`, one line: control characters are escaped.
[[nodiscard]] std::string to_string(const Diagnostic& diagnostic);

class Diagnostics {
  public:
    /// The number of findings of one severity that are kept; further ones are only counted. Hostile
    /// input cannot fill memory, and many warnings do not hide an error.
    static constexpr std::size_t kMaxKept = 1000;

    void warning(FileLocation location, std::string message);
    void error(FileLocation location, std::string message);

    [[nodiscard]] const std::vector<Diagnostic>& all() const { return kept_; }
    [[nodiscard]] std::size_t error_count() const { return error_count_; }
    [[nodiscard]] std::size_t warning_count() const { return warning_count_; }

    /// Records a file that is about to be read, so that no output replaces it.
    void note_file(const std::filesystem::path& path) { files_.insert(path); }
    [[nodiscard]] const std::set<std::filesystem::path>& files() const { return files_; }

    /// Throws `Error` (Scene) if there is any error; its message lists all errors, one per line, in
    /// the order of their lines.
    void throw_if_errors() const;
    /// Throws `Error` (Scene) if there is any warning; its message lists the warnings as errors.
    void throw_if_warnings() const;

  private:
    void throw_all(Severity severity, std::size_t count) const;
    void add(Severity severity, FileLocation location, std::string message);

    std::vector<Diagnostic> kept_;
    std::set<std::filesystem::path> files_;
    std::size_t error_count_ = 0;
    std::size_t warning_count_ = 0;
};

}  // namespace alhazen
