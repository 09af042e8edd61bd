#include "alhazen/accel/core/accelerator_settings.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "alhazen/base/error.h"

namespace alhazen {
namespace {

template <class T>
bool parse(const std::string& text, T& value) {
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    return status == std::errc{} && end == text.data() + text.size();
}

}  // namespace

const std::string* SettingsReader::find(const char* name) const {
    const auto found = settings_.find(name);
    return found == settings_.end() ? nullptr : &found->second;
}

void SettingsReader::refuse(const char* name, const std::string& value) const {
    throw Error(ErrorKind::Usage, fmt::format("accelerator '{}': {} = '{}', expected {}",
                                              accelerator_, name, value, described_.back().values));
}

double SettingsReader::number(const char* name, const char* what, double fallback, double least,
                              double most) {
    described_.push_back(
        {name, what, fmt::format("{} to {}", least, most), fmt::format("{}", fallback)});
    const std::string* text = find(name);
    if (text == nullptr) return fallback;
    double value = 0;
    if (!parse(*text, value) || !(least <= value && value <= most)) refuse(name, *text);
    return value;
}

int SettingsReader::count(const char* name, const char* what, int fallback, int least, int most) {
    described_.push_back(
        {name, what, fmt::format("{} to {}", least, most), fmt::format("{}", fallback)});
    const std::string* text = find(name);
    if (text == nullptr) return fallback;
    int value = 0;
    if (!parse(*text, value) || value < least || value > most) refuse(name, *text);
    return value;
}

bool SettingsReader::flag(const char* name, const char* what, bool fallback) {
    static constexpr const char* kNames[] = {"off", "on"};
    return choice(name, what, fallback ? 1 : 0, kNames) == 1;
}

std::size_t SettingsReader::choice(const char* name, const char* what, std::size_t fallback,
                                   std::span<const char* const> names) {
    std::string values;
    for (const char* n : names) values += values.empty() ? n : fmt::format(", {}", n);
    described_.push_back({name, what, values, names[fallback]});
    const std::string* text = find(name);
    if (text == nullptr) return fallback;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (*text == names[i]) return i;
    }
    refuse(name, *text);
}

void SettingsReader::exclude(const char* name, const char* other) const {
    if (find(name) == nullptr) return;
    throw Error(ErrorKind::Usage, fmt::format("accelerator '{}': {} has no effect beside {}",
                                              accelerator_, name, other));
}

void SettingsReader::finish() const {
    for (const auto& [name, value] : settings_) {
        std::string known;
        bool found = false;
        for (const SettingDescription& d : described_) {
            found = found || d.name == name;
            known += known.empty() ? d.name : ", " + d.name;
        }
        if (found) continue;
        throw Error(ErrorKind::Usage,
                    known.empty() ? fmt::format("accelerator '{}' has no settings, so no '{}'",
                                                accelerator_, name)
                                  : fmt::format("accelerator '{}' has no setting '{}'; it has: {}",
                                                accelerator_, name, known));
    }
}

AcceleratorChoice parse_accelerator(std::string_view text) {
    AcceleratorChoice choice;
    const std::size_t colon = text.find(':');
    choice.name = text.substr(0, colon);
    std::string_view rest = colon == std::string_view::npos ? "" : text.substr(colon + 1);
    while (!rest.empty()) {
        const std::size_t comma = rest.find(',');
        const std::string_view setting = rest.substr(0, comma);
        rest = comma == std::string_view::npos ? "" : rest.substr(comma + 1);
        const std::size_t equals = setting.find('=');
        if (equals == std::string_view::npos || equals == 0 || equals + 1 == setting.size()) {
            throw Error(ErrorKind::Usage, fmt::format("accelerator '{}': '{}', expected NAME=VALUE",
                                                      choice.name, setting));
        }
        const std::string name(setting.substr(0, equals));
        if (!choice.settings.emplace(name, setting.substr(equals + 1)).second) {
            throw Error(ErrorKind::Usage,
                        fmt::format("accelerator '{}': {} is set twice", choice.name, name));
        }
    }
    return choice;
}

}  // namespace alhazen
