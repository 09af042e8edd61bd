// Outlines of prisms and lathes.

#include "alhazen/formats/native/fields/native_shape_fields.h"

namespace alhazen {

namespace {

/// Reads one step of a loop: a point (the end of a line), or curve(control, control, point). False
/// after an error.
bool read_step(TextNode step, std::string_view key, const ValueReader& values, Vec2& last,
               Profile& profile) {
    if (!step.is(NodeKind::Entry, "curve")) {
        Vec2 to;
        if (!values.read(step, key, to)) return false;
        profile.curves.push_back(line_curve(last, to));
        last = to;
        return true;
    }
    constexpr const char* kExpected = "curve((x, y), (x, y), (x, y))";
    if (step.empty() || !step.first().is(NodeKind::List) || step.first().size() != 3) {
        return values.fail(step, key, kExpected);
    }
    Vec2 p[3];
    int i = 0;
    for (const TextNode point : step.first()) {
        if (!values.read(point, key, p[i++])) return false;
    }
    profile.curves.push_back(cubic_curve(last, p[0], p[1], p[2]));
    last = p[2];
    return true;
}

/// Reads `[(x, y), (x, y), curve(...), ...]`. `close`: adds a line from the end of a loop to its
/// beginning if they differ.
void read_loop(TextNode loop, std::string_view key, const ValueReader& values, bool close,
               Profile& profile) {
    if (!values.is_list(loop, key)) return;
    Vec2 first, last;
    bool begun = false;
    for (const TextNode step : loop) {
        if (begun) {
            if (!read_step(step, key, values, last, profile)) return;
        } else {
            if (!values.read(step, key, first)) return;
            last = first;
            begun = true;
        }
    }
    if (close && begun && last != first) profile.curves.push_back(line_curve(last, first));
    profile.loop_ends.push_back(static_cast<std::uint32_t>(profile.curves.size()));
}

Profile read_profile(BlockReader& reader, bool close) {
    Profile profile;
    const auto one = reader.find("profile");
    const auto loops = reader.find("loops");
    if (reader.has("profile") == reader.has("loops")) {
        reader.error(reader.block(), "expected either 'profile = ...' or 'loops = ...'");
        return profile;
    }
    if (one) read_loop(*one, "profile", reader.values(), close, profile);
    if (loops && reader.values().is_list(*loops, "loops")) {
        for (const TextNode loop : *loops) {
            read_loop(loop, "loops", reader.values(), close, profile);
        }
    }
    return profile;
}

}  // namespace

void read_native_field(BlockReader& reader, const Field<Prism, Profile>& field, Prism& shape) {
    shape.*field.member = read_profile(reader, true);
}

void read_native_field(BlockReader& reader, const Field<Lathe, Profile>& field, Lathe& shape) {
    shape.*field.member = read_profile(reader, false);
}

std::string native_field_text(const Profile& profile) {
    std::vector<std::string> loops;
    std::size_t begin = 0;
    for (const std::size_t end : profile.loop_ends) {
        std::vector<std::string> steps;
        for (std::size_t i = begin; i < end; ++i) {
            const ProfileCurve& c = profile.curves[i];
            if (i == begin) steps.push_back(native_value(c.p[0]));
            steps.push_back(c.line ? native_value(c.p[3])
                                   : "curve(" + native_value(c.p[1]) + ", " + native_value(c.p[2]) +
                                         ", " + native_value(c.p[3]) + ")");
        }
        loops.push_back(native_list(steps));
        begin = end;
    }
    return native_list(loops);
}

}  // namespace alhazen
