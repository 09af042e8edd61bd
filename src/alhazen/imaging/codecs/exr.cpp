#include "alhazen/imaging/codecs/exr.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <new>

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfIO.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include "alhazen/imaging/codecs/exr_header.h"
#include "alhazen/imaging/codecs/exr_memory.h"
#include "alhazen/imaging/codecs/half_range.h"
#include "alhazen/imaging/codecs/image_size.h"

namespace alhazen {

namespace {

/// An input stream of the checked header followed by the rest of the file.
class MemoryInput final : public Imf::IStream {
  public:
    MemoryInput(const std::string& header, std::string_view bytes, const std::string& name)
        : Imf::IStream(name.c_str()), header_(header), bytes_(bytes) {}

    bool read(char target[], int count) override {
        if (count < 0 || std::uint64_t(count) > bytes_.size() - position_) {
            throw std::runtime_error("the data end too early");
        }
        const auto end = position_ + std::size_t(count);
        const std::size_t from_header =
            std::min(end, header_.size()) - std::min(position_, header_.size());
        std::memcpy(target, header_.data() + std::min(position_, header_.size()), from_header);
        std::memcpy(target + from_header, bytes_.data() + position_ + from_header,
                    std::size_t(count) - from_header);
        position_ = end;
        return position_ < bytes_.size();
    }
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override {
        if (position > bytes_.size()) throw std::runtime_error("the data end too early");
        position_ = std::size_t(position);
    }

  private:
    const std::string& header_;
    std::string_view bytes_;
    std::size_t position_ = 0;
};

/// Of the parts that are not deep: the first with colours, else the first with a luminance, else
/// the first.
int part_to_read(const Imf::MultiPartInputFile& file, const ExrHeader& checked) {
    const auto is_deep = [&](int part) { return checked.parts.at(std::size_t(part)).deep; };
    const auto first_with = [&](std::initializer_list<const char*> channels) {
        for (int part = 0; part < file.parts(); ++part) {
            if (is_deep(part)) continue;
            const Imf::ChannelList& list = file.header(part).channels();
            for (const char* channel : channels) {
                if (list.findChannel(channel) != nullptr) return part;
            }
        }
        return -1;
    };
    if (const int colours = first_with({"R", "G", "B"}); colours >= 0) return colours;
    if (const int luminance = first_with({"Y"}); luminance >= 0) return luminance;
    int flat = 0;
    while (is_deep(flat)) ++flat;
    return flat;
}

std::vector<std::string> channel_names(const Imf::ChannelList& list, const std::string& name) {
    std::vector<std::string> names;
    for (auto it = list.begin(); it != list.end(); ++it) {
        names.emplace_back(it.name());
    }
    const auto has = [&](const char* channel) { return list.findChannel(channel) != nullptr; };
    std::vector<std::string> wanted;
    if (has("R") || has("G") || has("B")) {
        wanted = {"R", "G", "B"};
    } else if (has("RY") || has("BY")) {
        bad_image(name, "EXR pictures of luminance and chroma are not supported");
    } else if (has("Y")) {
        wanted = {"Y"};
    } else if (names.size() == 1) {
        return names;
    } else {
        std::string found;
        for (const std::string& channel : names) found += " " + channel;
        if (found.size() > 200) found = found.substr(0, 200) + "...";
        bad_image(name,
                  "expected an EXR with the channels R G B, or Y, or only one, found" + found);
    }
    if (has("A")) wanted.emplace_back("A");
    return wanted;
}

int band_rows(int height) {
    return std::min(height, 64);
}

/// The pixels of the display window that the data window holds; empty if it holds none.
HeldPixels held_pixels(const Imath::Box2i& data, const ExrWindow& display) {
    const auto x0 = std::max<std::int64_t>(data.min.x, display.x0);
    const auto y0 = std::max<std::int64_t>(data.min.y, display.y0);
    const auto x1 = std::min<std::int64_t>(data.max.x, display.x1);
    const auto y1 = std::min<std::int64_t>(data.max.y, display.y1);
    if (x1 < x0 || y1 < y0) return {};
    return {int(x0 - display.x0), int(y0 - display.y0), int(x1 - x0 + 1), int(y1 - y0 + 1)};
}

/// Decodes the rows of `held` in bands, so that a file that ends early takes memory only for the
/// data it has.
void read_bands(Imf::InputPart& file, const std::vector<std::string>& channels,
                const ExrWindow& display, const HeldPixels& held, Image& image) {
    const Imath::Box2i window = file.header().dataWindow();
    const std::size_t data_width = std::size_t(window.max.x - window.min.x + 1);
    const std::size_t row_samples = data_width * channels.size();
    const std::size_t image_row = std::size_t(image.width) * channels.size();
    const std::size_t left = std::size_t(held.x0) * channels.size();
    const auto skipped = std::size_t(held.x0 + display.x0 - window.min.x) * channels.size();
    const std::size_t kept = std::size_t(held.width) * channels.size();
    const int rows = band_rows(held.height);
    std::vector<float> band(row_samples * std::size_t(rows));
    image.samples.resize(image_row * std::size_t(held.y0));
    const int begin = int(held.y0 + display.y0), end = begin + held.height;
    for (int y = begin; y < end; y += rows) {
        const int last = std::min(y + rows, end) - 1;
        const Imath::Box2i place(Imath::V2i(window.min.x, y), Imath::V2i(window.max.x, last));
        Imf::FrameBuffer frame;
        for (std::size_t i = 0; i < channels.size(); ++i) {
            frame.insert(channels[i], Imf::Slice::Make(Imf::FLOAT, band.data() + i, place,
                                                       sizeof(float) * channels.size(),
                                                       sizeof(float) * row_samples));
        }
        file.setFrameBuffer(frame);
        file.readPixels(y, last);
        for (std::size_t row = 0; row < std::size_t(last - y + 1); ++row) {
            const std::size_t row_end = image.samples.size() + image_row;
            image.samples.resize(image.samples.size() + left);
            const float* from = band.data() + row * row_samples + skipped;
            image.samples.insert(image.samples.end(), from, from + kept);
            image.samples.resize(row_end);
        }
    }
}

Image read_exr(const ExrHeader& header, std::string_view bytes, const std::string& name,
               const ImageLimits& limits) {
    MemoryInput stream(header.bytes, bytes, name);
    Imf::MultiPartInputFile parts(stream, 0);
    const int number = part_to_read(parts, header);
    const ExrPart& checked = header.parts.at(std::size_t(number));
    Imf::InputPart file(parts, number);
    const Imath::Box2i window = file.header().dataWindow();
    const std::int64_t data_width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t width = checked.display.width(), height = checked.display.height();
    check_image_size(width, height, limits, name);
    const std::vector<std::string> channels = channel_names(file.header().channels(), name);
    for (const std::string& channel : channels) {
        const Imf::Channel* found = file.header().channels().findChannel(channel);
        if (found == nullptr) continue;
        if (found->xSampling != 1 || found->ySampling != 1) {
            bad_image(name, "EXR pictures with subsampled channels are not supported");
        }
        if (found->type == Imf::UINT) {
            bad_image(name,
                      "the EXR channel " + channel + " holds integers, expected half or float");
        }
    }
    const HeldPixels held = held_pixels(window, checked.display);
    // The decoder's buffers, checked with the header, are in memory at the same time.
    const std::uint64_t all =
        sample_bytes(width, height, channels.size(), sizeof(float)) + checked.decoder_bytes +
        sample_bytes(data_width, band_rows(held.height), channels.size(), sizeof(float));
    check_image_memory(all, limits, name);
    Image image = reserved_image(int(width), int(height), int(channels.size()), true, limits, name);
    image.associated = image.channels == 2 || image.channels == 4;
    if (held.width > 0) read_bands(file, channels, checked.display, held, image);
    image.samples.resize(std::size_t(width) * std::size_t(height) * channels.size());
    if (held.width == 0) {
        image.held = HeldPixels::none();
    } else if (held.width < image.width || held.height < image.height) {
        image.held = held;
    }
    return image;
}

// ---- writing

Imf::Header header_of(const Image& image, const ImageWriteOptions& options) {
    const bool crop = options.full_width > 0 || options.full_height > 0;
    const int x0 = crop ? options.crop_x0 : 0, y0 = crop ? options.crop_y0 : 0;
    const int full_width = crop ? options.full_width : image.width;
    const int full_height = crop ? options.full_height : image.height;
    if (x0 < 0 || y0 < 0 || x0 > full_width - image.width || y0 > full_height - image.height) {
        throw Error(ErrorKind::Usage, "cannot write an EXR: the crop leaves the full frame");
    }
    const Imath::Box2i display(Imath::V2i(0, 0), Imath::V2i(full_width - 1, full_height - 1));
    const Imath::Box2i data(Imath::V2i(x0, y0),
                            Imath::V2i(x0 + image.width - 1, y0 + image.height - 1));
    Imf::Header header(display, data);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [key, value] : options.metadata) {
        if (key.empty() || key.size() > 255 || key.find('\0') != std::string::npos) {
            throw Error(ErrorKind::Usage, "cannot write the metadata key \"" + key + "\"");
        }
        header.insert(key, Imf::StringAttribute(value));
    }
    return header;
}

template <class Sample>
void write_exr(ExrMemoryOutput& stream, const Image& image, Imf::Header header) {
    constexpr auto kType = std::is_same_v<Sample, float> ? Imf::FLOAT : Imf::HALF;
    static const std::array<std::vector<const char*>, 5> kNames{
        {{}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}}};
    const auto channels = std::size_t(image.channels);
    std::vector<Sample> halves;
    const Sample* samples = nullptr;
    if constexpr (std::is_same_v<Sample, float>) {
        samples = image.samples.data();
    } else {
        halves.resize(image.samples.size());
        std::transform(image.samples.begin(), image.samples.end(), halves.begin(),
                       [](float v) { return Sample(static_cast<float>(within_half(v))); });
        samples = halves.data();
    }
    Imf::FrameBuffer frame;
    for (std::size_t i = 0; i < channels; ++i) {
        const char* name = kNames[channels][i];
        header.channels().insert(name, Imf::Channel(kType));
        frame.insert(name, Imf::Slice::Make(kType, samples + i, header.dataWindow(),
                                            sizeof(Sample) * channels,
                                            sizeof(Sample) * channels * std::size_t(image.width)));
    }
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(frame);
    file.writePixels(image.height);
}

}  // namespace

void require_exr() {}

Image decode_exr(std::string_view bytes, const std::string& name, const ImageLimits& limits) {
    const ExrHeader header = checked_exr_header(bytes, name, limits);
    try {
        return read_exr(header, bytes, name, limits);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        bad_image(name, std::string("damaged EXR: ") + error.what());
    }
}

std::vector<std::byte> encode_exr(const Image& image, const ImageWriteOptions& options) {
    ExrMemoryOutput stream;
    try {
        const Imf::Header header = header_of(image, options);
        // Unused reserved memory costs nothing; growing would need twice the memory.
        stream.reserve(image.samples.size() * (options.full_float ? 4 : 2) + (1 << 20));
        if (options.full_float) {
            write_exr<float>(stream, image, header);
        } else {
            write_exr<Imath::half>(stream, image, header);
        }
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(ErrorKind::Usage, std::string("cannot write an EXR: ") + error.what());
    }
    return stream.take();
}

}  // namespace alhazen
