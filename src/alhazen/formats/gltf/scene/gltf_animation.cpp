#include "alhazen/formats/gltf/scene/gltf_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

namespace alhazen::gltf {

namespace {

/// The keys around a time: `from` and `from` + 1. Before the first and after the last key
/// `fraction` is 0 and only `from` is used.
struct Span {
    std::size_t from = 0;
    double fraction = 0;  ///< in [0, 1)
    double duration = 0;  ///< seconds between the keys
};

Span find_span(const std::vector<double>& times, double time) {
    // NaN compares false and gives the first key.
    if (!(time > times.front())) return {};
    if (time >= times.back()) return {times.size() - 1, 0, 0};
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    if (after == times.begin()) return {};  // occurs only if the times do not ascend
    const std::size_t from = std::size_t(after - times.begin()) - 1;
    const double duration = times[from + 1] - times[from];
    return {from, (time - times[from]) / duration, duration};
}

/// Component `c` of the value of a key.
double key_value(const Keys& keys, std::size_t key, std::size_t c) {
    const bool cubic = keys.interpolation == Interpolation::CubicSpline;
    return keys.values[(cubic ? 3 * key + 1 : key) * keys.width + c];
}

double cubic(const Keys& keys, const Span& span, std::size_t c) {
    const auto number = [&](std::size_t key, std::size_t part) {
        return keys.values[(3 * key + part) * keys.width + c];
    };
    const double t = span.fraction;
    const double t2 = t * t;
    const double t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * number(span.from, 1) +
           span.duration * (t3 - 2 * t2 + t) * number(span.from, 2) +
           (-2 * t3 + 3 * t2) * number(span.from + 1, 1) +
           span.duration * (t3 - t2) * number(span.from + 1, 0);
}

Quaternion slerp(const Quaternion& a, Quaternion b, double t) {
    double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    if (cosine < 0.0) {
        // -b is the same rotation along the shorter arc.
        for (double& c : b) c = -c;
        cosine = -cosine;
    }
    double wa = 1.0 - t, wb = t;
    const double angle = std::acos(std::min(cosine, 1.0));
    // For nearly equal rotations the sines cancel; linear interpolation is as accurate.
    if (const double sine = std::sin(angle); sine > 1e-6) {
        wa = std::sin((1.0 - t) * angle) / sine;
        wb = std::sin(t * angle) / sine;
    }
    return normalized({wa * a[0] + wb * b[0], wa * a[1] + wb * b[1], wa * a[2] + wb * b[2],
                       wa * a[3] + wb * b[3]});
}

std::size_t width_of(const Document& document, const AnimationChannel& channel) {
    switch (channel.path) {
        case AnimationPath::Translation:
        case AnimationPath::Scale:
            return 3;
        case AnimationPath::Rotation:
            return 4;
        case AnimationPath::Weights:
            break;
    }
    const std::optional<Index> mesh = document.nodes[*channel.node].mesh;
    if (!mesh || document.meshes[*mesh].primitives.empty()) return 0;
    return document.meshes[*mesh].primitives.front().targets.size();
}

class Animator {
  public:
    Animator(const Document& document, const ImportSource& source, Pose& pose, Budget& budget,
             Diagnostics& diagnostics)
        : document_(document),
          source_(source),
          pose_(pose),
          budget_(budget),
          diagnostics_(diagnostics) {}

    void apply(Index animation, double time) {
        const Animation& a = document_.animations[animation];
        for (std::size_t i = 0; i < a.channels.size(); ++i) {
            const AnimationChannel& channel = a.channels[i];
            if (!channel.node) continue;
            const AnimationSampler& sampler = a.samplers[channel.sampler];
            Keys keys;
            keys.width = width_of(document_, channel);
            keys.interpolation = sampler.interpolation;
            keys.times = times(sampler.input);
            keys.values = read(sampler.output);
            const std::size_t per_key =
                keys.width * (keys.interpolation == Interpolation::CubicSpline ? 3 : 1);
            if (keys.times.empty() || per_key == 0 ||
                keys.values.size() / per_key < keys.times.size()) {
                warn(animation, i, "has fewer values than keys; it is left out");
                continue;
            }
            set(channel, keys, time, animation, i);
        }
    }

  private:
    void set(const AnimationChannel& channel, const Keys& keys, double time, Index animation,
             std::size_t index) {
        NodePose& node = pose_[*channel.node];
        if (channel.path == AnimationPath::Weights) {
            budget_.make(keys.width, sizeof(double));
            node.weights = value_at(keys, time);
            return;
        }
        if (node.matrix) {
            warn(animation, index, "moves a node whose transform is a matrix; it is left out");
            return;
        }
        if (channel.path == AnimationPath::Rotation) {
            node.rotation = rotation_at(keys, time);
            return;
        }
        const std::vector<double> v = value_at(keys, time);
        (channel.path == AnimationPath::Translation ? node.translation : node.scale) = {v[0], v[1],
                                                                                        v[2]};
    }

    void warn(Index animation, std::size_t channel, const char* what) {
        diagnostics_.warning(
            {source_.path.string(), 0, 0},
            fmt::format("#/animations/{}/channels/{}: the channel {}", animation, channel, what));
    }

    std::vector<double> read(Index accessor) {
        budget_.take(document_.accessors[accessor].count);
        return read_numbers(document_, accessor);
    }

    /// Key times, read once: many channels share them.
    const std::vector<double>& times(Index accessor) {
        const auto [entry, fresh] = times_.try_emplace(accessor);
        if (fresh) entry->second = read(accessor);
        return entry->second;
    }

    const Document& document_;
    const ImportSource& source_;
    Pose& pose_;
    Budget& budget_;
    Diagnostics& diagnostics_;
    std::map<Index, std::vector<double>> times_;
};

std::string list_of(const std::vector<Animation>& animations) {
    std::string text;
    for (std::size_t i = 0; i < animations.size() && i < 50; ++i) {
        text += fmt::format("{}{}", i == 0 ? "" : ", ", i);
        if (!animations[i].name.empty()) text += fmt::format(" '{}'", animations[i].name);
    }
    return text.empty() ? "the file has none" : "the file has " + text;
}

/// The animation of that name, else the one at that index.
Index find_animation(const Document& document, const std::string& wanted) {
    const auto& animations = document.animations;
    for (Index i = 0; i < animations.size(); ++i) {
        if (animations[i].name == wanted) return i;
    }
    Index position = 0;
    const char* end = wanted.data() + wanted.size();
    const auto [stop, failure] = std::from_chars(wanted.data(), end, position);
    if (failure == std::errc() && stop == end && position < animations.size()) return position;
    throw Error(ErrorKind::Usage,
                fmt::format("no animation '{}'; {}", wanted, list_of(animations)));
}

}  // namespace

std::vector<double> value_at(const Keys& keys, double time) {
    const Span span = find_span(keys.times, time);
    std::vector<double> value(keys.width);
    for (std::size_t c = 0; c < keys.width; ++c) {
        const double here = key_value(keys, span.from, c);
        if (span.fraction == 0.0 || keys.interpolation == Interpolation::Step) {
            value[c] = here;
        } else if (keys.interpolation == Interpolation::CubicSpline) {
            value[c] = cubic(keys, span, c);
        } else {
            value[c] =
                (1.0 - span.fraction) * here + span.fraction * key_value(keys, span.from + 1, c);
        }
    }
    return value;
}

Quaternion rotation_at(const Keys& keys, double time) {
    const Span span = find_span(keys.times, time);
    if (keys.interpolation != Interpolation::Linear || span.fraction == 0.0) {
        const std::vector<double> v = value_at(keys, time);
        return normalized({v[0], v[1], v[2], v[3]});
    }
    const auto rotation = [&](std::size_t key) {
        return normalized({key_value(keys, key, 0), key_value(keys, key, 1),
                           key_value(keys, key, 2), key_value(keys, key, 3)});
    };
    return slerp(rotation(span.from), rotation(span.from + 1), span.fraction);
}

void apply_animations(const Document& document, const ImportSource& source, Pose& pose,
                      Budget& budget, Diagnostics& diagnostics) {
    const ImportOptions& options = source.options;
    std::optional<Index> only;
    if (!options.animation.empty()) only = find_animation(document, options.animation);
    if (!options.time) return;
    if (document.animations.empty()) {
        diagnostics.warning({source.path.string(), 0, 0},
                            "a time is given, but the file has no animations");
    }
    Animator animator(document, source, pose, budget, diagnostics);
    for (Index i = 0; i < document.animations.size(); ++i) {
        if (!only || *only == i) animator.apply(i, *options.time);
    }
}

}  // namespace alhazen::gltf
