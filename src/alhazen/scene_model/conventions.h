#pragma once
/// Conventions of a scene file, grouped by their reader: everything in which scene formats differ
/// about the meaning of a picture.
///
/// ADD A CONVENTION HERE: a field in the struct of its reader. The native format reads and writes
/// it (formats/native/read/native_settings.cpp, formats/native/write/native_write_view.cpp;
/// docs/reference/formats/native.md), and tests/support/same_description.h compares it (it does not
/// compile until it does).

#include "alhazen/imaging/film/film_conventions.h"
#include "alhazen/sampling/sampling_conventions.h"
#include "alhazen/shading/shading_conventions.h"

namespace alhazen {

/// Changes made to a description on its way to the compiled scene.
struct ImportConventions {
    /// Colours c of materials, not textures, are used as floor(255 c) / 255. Applied by `compile`.
    bool truncate_material_colors = false;
    /// A file without lights gets one at the eye (`complete_view`); false: its darkness is
    /// intended.
    bool headlight = true;
    /// A file with lights and no background gets dim neutral light from all directions, and a
    /// background of that colour (`complete_view`).
    bool surroundings = false;
};

struct Conventions {
    ShadingConventions shading;    ///< read by renderers
    SamplingConventions sampling;  ///< read by samplers
    FilmConventions film;          ///< read by picture writers
    ImportConventions importing;   ///< read by `compile` and the session
};

}  // namespace alhazen
