#pragma once
/// Settings of renderers, and of other things with a name, as users write them:
/// "NAME:SETTING=VALUE,...".
///
/// Conventions: a setting is read once; what was not read is unknown to the renderer. All functions
/// throw Error (Usage).

#include <map>
#include <set>
#include <span>
#include <string>

namespace alhazen {

class RendererSettings {
  public:
    /// Splits the text; `name` is that of the renderer. Errors call it `subject`.
    explicit RendererSettings(const std::string& text, const char* subject = "renderer");

    [[nodiscard]] const std::string& name() const { return name_; }
    /// Within [least, most].
    [[nodiscard]] double number(const char* setting, double fallback, double least, double most);
    [[nodiscard]] int whole(const char* setting, int fallback, int least, int most);
    /// The index among `names`.
    [[nodiscard]] std::size_t choice(const char* setting, std::size_t fallback,
                                     std::span<const char* const> names);
    /// Refuses settings that were not read.
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
