#pragma once
/// State that the functions of the .ray importer share while they read a file.

#include <filesystem>
#include <optional>

#include "alhazen/formats/core/importer.h"
#include "alhazen/formats/ray/ray_family.h"

namespace alhazen {

/// The camera of the programs, which each camera block changes.
struct RayCamera {
    Vec3 eye;
    Mat3 axes;                    ///< right, up and backward; lengths and angles as in the file
    std::optional<Vec3> look_at;  ///< if the axes are towards it
    std::optional<Vec3> up;       ///< then: `updir`, if given
    /// Where the file says so, if `look_at` is at the eye or along `up` from it.
    std::optional<FileLocation> without_axes;
    double height = 1;  ///< of the image at distance 1: 53.13 degrees
    double aspect = 1;
};

struct RayContext {
    SceneDescription& scene;
    Diagnostics& diagnostics;
    const ImportOptions& options;
    RayFamily family;
    std::uint64_t elements = 0;      ///< vertices, triangles and parts so far
    bool reported_rounding = false;  ///< a warning about a rounded matrix was given
    RayCamera camera = {};

    /// Throws Error (Resource) beyond options.max_elements.
    void count_elements(std::uint64_t more, const FileLocation& where) {
        elements += more;
        if (elements > options.max_elements) {
            throw Error(ErrorKind::Resource,
                        "more than " + std::to_string(options.max_elements) +
                            " vertices, triangles and objects",
                        where);
        }
    }
};

}  // namespace alhazen
