#include "rendering.h"

#include <algorithm>

#include "alhazen/base/error.h"
#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/session/conversion/tessellated.h"
#include "alhazen/session/environment_option.h"
#include "array_making.h"
#include "interruptible.h"

namespace py = pybind11;

namespace alhazen::python {

namespace {

py::object array_of(const LayerChannel& channel, int width, int height) {
    const Shape shape{height, width};
    if (channel.type == SampleType::Uint) {
        const PlainArray<std::uint32_t> array(shape);
        std::copy(channel.whole.begin(), channel.whole.end(), array.data());
        return array.array();
    }
    const PlainArray<float> array(shape);
    std::copy(channel.values.begin(), channel.values.end(), array.data());
    return array.array();
}

/// The channels of the layers by name, one array (h, w) each.
py::dict layers_of(const RenderResult& result) {
    py::dict layers;
    for (const LayerChannel& channel : result.layers.channels()) {
        layers[py::str(channel.name)] =
            array_of(channel, result.film.crop().width(), result.film.crop().height());
    }
    return layers;
}

py::array image_of(const Film& film) {
    const Image image = film.to_image();
    const PlainArray<float> pixels({image.height, image.width, image.channels});
    std::copy(image.samples.begin(), image.samples.end(), pixels.data());
    return pixels.array();
}

void complete_options(PictureWishes& wishes) {
    RenderOptions& options = wishes.render;
    if (!wishes.layers.empty()) options.aovs = parse_aovs(wishes.layers);
    options.sampling = parse_sampling(wishes.sampling);
    if (!wishes.antialias.empty()) options.antialias = parse_antialias(wishes.antialias);
    if (wishes.spp) {
        options.samples_per_pixel = *wishes.spp;
    } else if (options.sampling && options.sampling->has_rounds()) {
        options.samples_per_pixel = SamplingPlan::kMostByRule;
    } else {
        options.samples_per_pixel = make_renderer(options.renderer)->usual_samples();
    }
    check_environment(wishes.view.environment, options.renderer);
    options.count_tests = options.aovs.has_tests();
}

}  // namespace

py::dict render_picture(const BuiltScene& scene, PictureWishes wishes, const py::object& progress) {
    complete_options(wishes);
    RenderOptions& options = wishes.render;
    StopFlag stop;
    options.stop = &stop;
    std::optional<RenderResult> result;
    std::vector<std::string> notes;
    run_watched(stop, progress, [&](ProgressSink& sink) {
        options.progress = &sink;
        LoadedScene view = scene.loaded();  // shares all geometry
        notes = prepare_view(view, options, wishes.view);
        for (std::string& note : notes) note = with_arguments(note);
        const double within = make_renderer(options.renderer)->takes_triangles_within();
        if (within > 0) (void)tessellate(view.description, within);
        result.emplace(render(view, options));
    });
    py::dict picture;
    picture["image"] = image_of(result->film);
    picture["layers"] = layers_of(*result);
    picture["notes"] = notes;
    picture["complete"] = result->complete;
    picture["seconds"] = result->seconds;
    picture["rays"] = result->counters.total_cast();
    return picture;
}

py::bytes encode_picture(const std::string& suffix, const py::array_t<float>& pixels) {
    const auto plain = py::array_t<float, py::array::c_style | py::array::forcecast>(pixels);
    const int channels = plain.ndim() == 3 ? static_cast<int>(plain.shape(2)) : 1;
    if (plain.ndim() < 2 || plain.ndim() > 3 || (channels != 1 && channels != 3)) {
        throw Error(ErrorKind::Usage, "a picture has the shape (h, w), (h, w, 1) or (h, w, 3)");
    }
    Image image(static_cast<int>(plain.shape(1)), static_cast<int>(plain.shape(0)), channels);
    std::copy_n(plain.data(), image.samples.size(), image.samples.begin());
    std::vector<std::byte> bytes;
    {
        const py::gil_scoped_release released;
        bytes = encode_image(suffix, image);
    }
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace alhazen::python
