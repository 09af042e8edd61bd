#pragma once
/// The arguments of `alhazen render`: their options, and the checks of them.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/imaging/image/encoding.h"
#include "alhazen/imaging/image/tone_mapping.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/core/sampling_plan.h"
#include "alhazen/session/render.h"
#include "options.h"

namespace alhazen::cli {

struct RenderArguments {
    SceneArguments scene;
    std::string output;
    std::string size, crop, encoding, protocol, stats, tables, photons, aovs, view, antialias;
    std::string projection;
    int depth = -1;
    int bits = 8;
    bool full_float = false, aov_png = false, quiet = false, no_counts = false, spectral = false;
    SamplingTexts sampling;
    std::optional<int> spp;
    RenderOptions render;
    std::string environment, tonemap;
    ToneMapping tone;
    bool names_tone = false;  ///< one of its options is given, whatever its value

    void add_to(CLI::App& command);
};

/// Throws Error (Usage) for an unknown name.
[[nodiscard]] Encoding parse_encoding(const std::string& name);
/// Throws Error (Usage) for an unknown curve.
[[nodiscard]] ToneMapping tone_mapping(const RenderArguments& args);
/// True if layers are written as separate pictures: without an EXR file, or on request.
[[nodiscard]] bool writes_aov_pictures(const RenderArguments& args);

struct CheckedRender {
    RenderOptions options;
    std::unique_ptr<Renderer> renderer;
    std::vector<std::filesystem::path> outputs;  ///< all of them, different and writable
};

/// The options of rendering, checked before any work. Throws Error (Usage, File).
[[nodiscard]] CheckedRender checked(const RenderArguments& args);

}  // namespace alhazen::cli
