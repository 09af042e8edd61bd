#include "alhazen/base/diagnostics.h"

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
    std::string text;
    std::size_t listed = 0;
    for (const Diagnostic& diagnostic : kept_) {
        if (diagnostic.severity != severity) continue;
        if (!text.empty()) text += '\n';
        text += to_string({Severity::Error, diagnostic.location, diagnostic.message});
        ++listed;
    }
    if (listed < count) text += "\n(and " + std::to_string(count - listed) + " more errors)";
    throw Error(ErrorKind::Scene, text);
}

}  // namespace alhazen
