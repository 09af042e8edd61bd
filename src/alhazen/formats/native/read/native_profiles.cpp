// The solids of the native format that are made of outlines: prism and lathe.

#include "alhazen/formats/native/read/native_solids.h"

namespace alhazen {

namespace {

/// One step of a loop: a point, to which a line leads, or curve(control, control, point). False
/// after a mistake.
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

/// `[(x, y), (x, y), curve(...), ...]`; a loop that does not end where it begins is closed by a
/// line, if it is to be.
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

AnyShape read_native_prism(BlockReader& reader) {
    Prism prism;
    prism.profile = read_profile(reader, true);
    reader.read("h0", prism.h0);
    reader.read("h1", prism.h1);
    reader.read("top_scale", prism.top_scale);
    return prism;
}

AnyShape read_native_lathe(BlockReader& reader) {
    Lathe lathe;
    lathe.profile = read_profile(reader, false);
    return lathe;
}

}  // namespace alhazen
