#pragma once
/// Textual settings of accelerators: `name=value`, each checked and described in one place.
///
/// An accelerator declares its settings by reading them (`A::configure`); the recorded calls are
/// the list that `alhazen list accelerators` prints.

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alhazen {

/// Name to value, as written.
using AcceleratorSettings = std::map<std::string, std::string>;

/// A setting and its valid values.
struct SettingDescription {
    std::string name;
    std::string what;      ///< one line
    std::string values;    ///< "3 to 20", "sphere, box"
    std::string fallback;  ///< the default
};

class SettingsReader {
  public:
    /// `accelerator` is for messages only.
    SettingsReader(std::string accelerator, const AcceleratorSettings& settings)
        : accelerator_(std::move(accelerator)), settings_(settings) {}

    /// Throw Error(Usage) for an invalid value or one out of range.
    [[nodiscard]] double number(const char* name, const char* what, double fallback, double least,
                                double most);
    [[nodiscard]] int count(const char* name, const char* what, int fallback, int least, int most);
    [[nodiscard]] bool flag(const char* name, const char* what, bool fallback);
    /// The index of the value among `names`.
    [[nodiscard]] std::size_t choice(const char* name, const char* what, std::size_t fallback,
                                     std::span<const char* const> names);

    /// Throws Error(Usage) if the setting `name` was given: `other` is used in place of it.
    void exclude(const char* name, const char* other) const;
    /// Throws Error(Usage) if a setting was given that was not read.
    void finish() const;
    [[nodiscard]] const std::vector<SettingDescription>& described() const { return described_; }

  private:
    [[nodiscard]] const std::string* find(const char* name) const;
    [[noreturn]] void refuse(const char* name, const std::string& value) const;

    std::string accelerator_;
    const AcceleratorSettings& settings_;
    std::vector<SettingDescription> described_;
};

/// Splits "name:key=value,key=value". Throws Error(Usage) for a setting without a value or given
/// twice.
struct AcceleratorChoice {
    std::string name;
    AcceleratorSettings settings;
};
[[nodiscard]] AcceleratorChoice parse_accelerator(std::string_view text);

}  // namespace alhazen
