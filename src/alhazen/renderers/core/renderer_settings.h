#pragma once
/// Parser of a name with settings, as users write it for renderers and others:
/// "NAME:SETTING=VALUE,...".
///
/// Conventions: each setting is read once; settings that were not read are unknown. All functions
/// throw Error (Usage).

#include <map>
#include <set>
#include <span>
#include <string>

namespace alhazen {

class RendererSettings {
  public:
    /// Splits the text. `subject`: the kind of thing that is named, for error messages.
    explicit RendererSettings(const std::string& text, const char* subject = "renderer");

    [[nodiscard]] const std::string& name() const { return name_; }
    /// The value of a setting in [least, most], or `fallback`.
    [[nodiscard]] double number(const char* setting, double fallback, double least, double most);
    [[nodiscard]] int whole(const char* setting, int fallback, int least, int most);
    /// The index in `names` of the value of a setting, or `fallback`.
    [[nodiscard]] std::size_t choice(const char* setting, std::size_t fallback,
                                     std::span<const char* const> names);
    /// Throws if a setting was not read.
    void finish() const;

  private:
    [[nodiscard]] const std::string* find(const char* setting);
    [[noreturn]] void refuse(const std::string& what) const;

    const char* subject_;
    std::string name_;
    std::map<std::string, std::string> values_;
    std::set<std::string> known_;
};

}  // namespace alhazen
