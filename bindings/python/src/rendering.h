#pragma once
/// Rendered pictures as numpy arrays.

#include <pybind11/numpy.h>

#include <optional>
#include <string>
#include <vector>

#include "alhazen/session/prepare_view.h"
#include "built_scene.h"

namespace alhazen::python {

struct PictureWishes {
    RenderOptions render;  ///< without `stop` and `progress`
    std::string layers;    ///< as for `--aov`; empty: none
    ViewRequest view;
    std::string antialias;  ///< as for `--antialias`; empty: none
    SamplingTexts sampling;
    std::optional<int> spp;
};

/// Renders a dict of image (h, w, 3) float32, layers (dict of channels (h, w)), notes, complete,
/// seconds, rays. Throws Error.
[[nodiscard]] pybind11::dict render_picture(const BuiltScene& scene, PictureWishes wishes,
                                            const pybind11::object& progress);

/// The bytes of a picture file with this suffix from an array (h, w), (h, w, 1) or (h, w, 3) of
/// linear values.
[[nodiscard]] pybind11::bytes encode_picture(const std::string& suffix,
                                             const pybind11::array_t<float>& pixels);

}  // namespace alhazen::python
