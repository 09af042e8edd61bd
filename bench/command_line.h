#pragma once
/// Options of a benchmark program: `--name value`, flags and positional arguments.

#include <fmt/format.h>

#include <map>
#include <string>
#include <vector>

#include "alhazen/base/error.h"

namespace alhazen::bench {

class CommandLine {
  public:
    /// `options` are the names with a value, `flags` those without. Throws Error (Usage).
    CommandLine(int argc, char** argv, const std::vector<std::string>& options,
                const std::vector<std::string>& flags = {}) {
        const auto has = [](const std::vector<std::string>& list, const std::string& name) {
            for (const std::string& entry : list) {
                if (entry == name) return true;
            }
            return false;
        };
        for (int i = 1; i < argc; ++i) {
            const std::string argument = argv[i];
            if (!argument.starts_with("--")) {
                rest.push_back(argument);
            } else if (has(flags, argument)) {
                values_[argument] = "yes";
            } else if (!has(options, argument)) {
                throw Error(ErrorKind::Usage,
                            fmt::format("unknown option {}, expected one of {} {}", argument,
                                        fmt::join(options, " "), fmt::join(flags, " ")));
            } else if (i + 1 == argc) {
                throw Error(ErrorKind::Usage, argument + " needs a value");
            } else {
                values_[argument] = argv[++i];
            }
        }
    }

    std::vector<std::string> rest;

    [[nodiscard]] bool has(const std::string& name) const { return values_.contains(name); }
    [[nodiscard]] std::string text(const std::string& name, const std::string& otherwise) const {
        const auto place = values_.find(name);
        return place == values_.end() ? otherwise : place->second;
    }
    /// A number that is at least 1, possibly in the form 1e6. Throws Error (Usage).
    [[nodiscard]] std::size_t count(const std::string& name, std::size_t otherwise) const {
        const auto place = values_.find(name);
        if (place == values_.end()) return otherwise;
        char* end = nullptr;
        const double value = std::strtod(place->second.c_str(), &end);
        if (*end != 0 || !(value >= 1 && value <= 1e15)) {
            throw Error(ErrorKind::Usage,
                        fmt::format("{} is {}, expected a number from 1 on", name, place->second));
        }
        return static_cast<std::size_t>(value);
    }

  private:
    std::map<std::string, std::string> values_;
};

}  // namespace alhazen::bench
