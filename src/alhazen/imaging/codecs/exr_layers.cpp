#include "alhazen/imaging/codecs/exr_layers.h"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <new>

#include "alhazen/base/error.h"
#include "alhazen/imaging/codecs/exr_memory.h"
#include "alhazen/imaging/codecs/half_range.h"

namespace alhazen {

namespace {

[[noreturn]] void refuse(const std::string& why) {
    throw Error(ErrorKind::Usage, "cannot write an EXR: " + why);
}

/// Collects the channels and keeps converted samples until the file is written.
class LayersFile {
  public:
    LayersFile(const Film& film, const ExrLayersOptions& options)
        : crop_(film.crop()), header_(make_header(film, options.metadata)) {}

    void add_beauty(const Film& film, bool full_float) {
        static constexpr const char* kNames[] = {"R", "G", "B"};
        const double* from = film.data();
        for (std::size_t c = 0; c < 3; ++c) {
            std::vector<float> values(crop_.area());
            for (std::size_t i = 0; i < values.size(); ++i) {
                const double value = from[3 * i + c];
                values[i] = static_cast<float>(full_float ? value : within_half(value));
            }
            if (full_float) {
                floats_.push_back(std::move(values));
                insert(kNames[c], Imf::FLOAT, floats_.back().data());
            } else {
                add_half(kNames[c], values);
            }
        }
    }

    void add(const LayerChannel& channel) {
        if (channel.type == SampleType::Half) {
            add_half(channel.name, channel.values);
        } else if (channel.type == SampleType::Float) {
            insert(channel.name, Imf::FLOAT, channel.values.data());
        } else {
            insert(channel.name, Imf::UINT, channel.whole.data());
        }
    }

    void write(ExrMemoryOutput& stream) const {
        Imf::OutputFile file(stream, header_, 0);
        file.setFrameBuffer(frame_);
        file.writePixels(crop_.height());
    }

  private:
    static Imf::Header make_header(const Film& film, const ImageMetadata& metadata) {
        const PixelBox& crop = film.crop();
        const Imath::Box2i display(Imath::V2i(0, 0),
                                   Imath::V2i(film.frame_width() - 1, film.frame_height() - 1));
        const Imath::Box2i data(Imath::V2i(crop.x0, crop.y0), Imath::V2i(crop.x1 - 1, crop.y1 - 1));
        Imf::Header header(display, data);
        header.compression() = Imf::ZIP_COMPRESSION;
        for (const auto& [key, value] : metadata) {
            if (key.empty() || key.size() > 255 || key.find('\0') != std::string::npos) {
                refuse("the metadata key \"" + key + "\"");
            }
            header.insert(key, Imf::StringAttribute(value));
        }
        return header;
    }

    void add_half(const std::string& name, const std::vector<float>& values) {
        std::vector<Imath::half>& halves = halves_.emplace_back(values.size());
        std::transform(values.begin(), values.end(), halves.begin(),
                       [](float v) { return Imath::half(static_cast<float>(within_half(v))); });
        insert(name, Imf::HALF, halves.data());
    }

    template <class Sample>
    void insert(const std::string& name, Imf::PixelType type, const Sample* samples) {
        if (name.empty() || header_.channels().findChannel(name) != nullptr) {
            refuse("two channels \"" + name + "\"");
        }
        header_.channels().insert(name, Imf::Channel(type));
        // The library takes a pointer to char for reading and writing; here it only reads.
        frame_.insert(
            name, Imf::Slice::Make(type, const_cast<Sample*>(samples), header_.dataWindow(),
                                   sizeof(Sample), sizeof(Sample) * std::size_t(crop_.width())));
    }

    PixelBox crop_;
    Imf::Header header_;
    Imf::FrameBuffer frame_;
    std::vector<std::vector<float>> floats_;
    std::vector<std::vector<Imath::half>> halves_;
};

}  // namespace

std::vector<std::byte> encode_exr_layers(const Film& film, const FilmLayers& layers,
                                         const ExrLayersOptions& options) {
    if (!layers.channels().empty() && !(layers.crop() == film.crop())) {
        refuse("the layers have another crop than the picture");
    }
    ExrMemoryOutput stream;
    try {
        LayersFile file(film, options);
        file.add_beauty(film, options.full_float);
        for (const LayerChannel& channel : layers.channels()) file.add(channel);
        file.write(stream);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        refuse(error.what());
    }
    return stream.take();
}

}  // namespace alhazen
