#include "alhazen/base/diagnostics.h"

#include <algorithm>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>

#include "alhazen/base/control_characters.h"

namespace alhazen {

std::string to_string(const Diagnostic& diagnostic) {
    const std::string place = to_string(diagnostic.location);
    const char* kind = diagnostic.severity == Severity::Error ? "error: " : "warning: ";
    return escape_controls((place.empty() ? "" : place + ": ") + kind + diagnostic.message);
}

void Diagnostics::warning(FileLocation location, std::string message) {
    if (++warning_count_ > kMaxKept) return;
    add(Severity::Warning, std::move(location), std::move(message));
}

void Diagnostics::error(FileLocation location, std::string message) {
    if (++error_count_ > kMaxKept) return;
    add(Severity::Error, std::move(location), std::move(message));
}

void Diagnostics::add(Severity severity, FileLocation location, std::string message) {
    kept_.push_back({severity, std::move(location), std::move(message)});
}

void Diagnostics::throw_if_errors() const {
    throw_all(Severity::Error, error_count_);
}

void Diagnostics::throw_if_warnings() const {
    throw_all(Severity::Warning, warning_count_);
}

void Diagnostics::throw_all(Severity severity, std::size_t count) const {
    if (count == 0) return;
    std::vector<const Diagnostic*> found;
    std::map<std::string_view, std::size_t> files;  // their order
    for (const Diagnostic& diagnostic : kept_) {
        if (diagnostic.severity != severity) continue;
        found.push_back(&diagnostic);
        files.emplace(diagnostic.location.file, files.size());
    }
    const auto place = [&](const Diagnostic* diagnostic) {
        const FileLocation& at = diagnostic->location;
        return std::tuple(files.at(at.file), at.line, at.column);
    };
    std::stable_sort(found.begin(), found.end(),
                     [&](const Diagnostic* a, const Diagnostic* b) { return place(a) < place(b); });
    std::string text;
    for (const Diagnostic* diagnostic : found) {
        if (!text.empty()) text += '\n';
        text += to_string({Severity::Error, diagnostic->location, diagnostic->message});
    }
    if (found.size() < count) {
        text += "\n(and " + std::to_string(count - found.size()) + " more errors)";
    }
    throw Error(ErrorKind::Scene, text);
}

}  // namespace alhazen
