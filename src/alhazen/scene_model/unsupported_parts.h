#pragma once
/// Parts of a scene that a renderer cannot show.

#include <string>
#include <string_view>

#include "alhazen/base/control_characters.h"
#include "alhazen/base/error.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

class UnsupportedParts {
  public:
    /// Notes a part: what it is, its name (may be empty) and the line of the file, if known.
    void add(std::string_view what, const std::string& name, const FileLocation& where) {
        if (++count_ > kMostNamed) return;
        if (!list_.empty()) list_ += "; ";
        list_ += what;
        if (!name.empty()) list_ += " '" + escape_controls(name) + "'";
        if (where.line > 0) list_ += " (line " + std::to_string(where.line) + ")";
    }

    void add(const ObjectDescription& solid) {
        add("solid of constructive geometry", solid.name, solid.location);
    }

    /// Throws Error (Usage) with what is supported and the parts noted, if there are any.
    void throw_if_any(const std::string& supported) const {
        if (count_ == 0) return;
        const int more = count_ - kMostNamed;
        throw Error(ErrorKind::Usage,
                    supported + "; unsupported: " + list_ +
                        (more > 0 ? "; and " + std::to_string(more) + " more" : ""));
    }

  private:
    static constexpr int kMostNamed = 20;
    int count_ = 0;
    std::string list_;
};

}  // namespace alhazen
