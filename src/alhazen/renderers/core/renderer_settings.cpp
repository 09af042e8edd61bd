#include "alhazen/renderers/core/renderer_settings.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "alhazen/base/error.h"

namespace alhazen {

RendererSettings::RendererSettings(const std::string& text, const char* subject)
    : subject_(subject), name_(text, 0, text.find(':')) {
    if (name_.size() == text.size()) return;
    std::string rest = text.substr(name_.size() + 1);
    while (!rest.empty()) {
        const std::string setting = rest.substr(0, rest.find(','));
        rest = setting.size() == rest.size() ? "" : rest.substr(setting.size() + 1);
        const std::size_t equals = setting.find('=');
        if (equals == std::string::npos || equals == 0 || equals + 1 == setting.size()) {
            refuse("'" + setting + "', expected NAME=VALUE");
        }
        const std::string name = setting.substr(0, equals);
        if (!values_.emplace(name, setting.substr(equals + 1)).second) {
            refuse(name + " is set twice");
        }
    }
}

double RendererSettings::number(const char* setting, double fallback, double least, double most) {
    const std::string* text = find(setting);
    if (text == nullptr) return fallback;
    double value = 0.0;
    const char* const end = text->data() + text->size();
    const auto [read, failed] = std::from_chars(text->data(), end, value);
    if (failed != std::errc{} || read != end || !(value >= least && value <= most)) {
        refuse(fmt::format("{}={}, expected a number from {} to {}", setting, *text, least, most));
    }
    return value;
}

int RendererSettings::whole(const char* setting, int fallback, int least, int most) {
    const double value = number(setting, fallback, least, most);
    if (value != std::floor(value)) {
        refuse(fmt::format("{}={}, expected a whole number", setting, value));
    }
    return static_cast<int>(value);
}

std::size_t RendererSettings::choice(const char* setting, std::size_t fallback,
                                     std::span<const char* const> names) {
    const std::string* text = find(setting);
    if (text == nullptr) return fallback;
    std::string known;
    for (std::size_t k = 0; k < names.size(); ++k) {
        if (*text == names[k]) return k;
        known += (known.empty() ? "" : ", ") + std::string(names[k]);
    }
    refuse(fmt::format("{}={}, expected one of {}", setting, *text, known));
}

void RendererSettings::finish() const {
    for (const auto& [name, value] : values_) {
        if (known_.contains(name)) continue;
        std::string known;
        for (const std::string& k : known_) known += (known.empty() ? "" : ", ") + k;
        refuse("unknown setting '" + name + "'" +
               (known.empty() ? "; it has none" : "; known: " + known));
    }
}

const std::string* RendererSettings::find(const char* setting) {
    known_.insert(setting);
    const auto found = values_.find(setting);
    return found == values_.end() ? nullptr : &found->second;
}

void RendererSettings::refuse(const std::string& what) const {
    throw Error(ErrorKind::Usage, std::string(subject_) + " '" + name_ + "': " + what);
}

}  // namespace alhazen
