#pragma once
/// Conventions of a scene file, by their reader: everything in which scene formats differ about
/// the meaning of a picture.
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
    /// Every material colour c of the file is used as floor(255 c) / 255. Applied by `compile`.
    bool truncate_material_colors = false;
    /// A file without lights is given one at the eye (`complete_view`); false: it is meant to be
    /// dark.
    bool headlight = true;
    /// A file with lights of its own and no background is given dim neutral light from everywhere,
    /// and a background of that colour (`complete_view`).
    bool surroundings = false;
};

struct Conventions {
    ShadingConventions shading;    ///< renderers
    SamplingConventions sampling;  ///< samplers
    FilmConventions film;          ///< writers of pictures
    ImportConventions importing;   ///< `compile` and the session
};

}  // namespace alhazen
