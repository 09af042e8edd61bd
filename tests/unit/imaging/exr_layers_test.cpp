#include "alhazen/imaging/codecs/exr_layers.h"

#include <gtest/gtest.h>
#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIO.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/base/error.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Input stream for the OpenEXR library over bytes in memory.
class Bytes final : public Imf::IStream {
  public:
    explicit Bytes(const std::vector<std::byte>& bytes) : Imf::IStream("test"), bytes_(bytes) {}
    bool read(char target[], int count) override {
        std::memcpy(target, bytes_.data() + at_, static_cast<std::size_t>(count));
        at_ += static_cast<std::size_t>(count);
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t position) override { at_ = position; }

  private:
    const std::vector<std::byte>& bytes_;
    std::size_t at_ = 0;
};

template <class Sample>
std::vector<Sample> read_channel(Imf::InputFile& file, const char* name, Imf::PixelType type) {
    const Imath::Box2i window = file.header().dataWindow();
    const std::size_t width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
    const std::size_t height = static_cast<std::size_t>(window.max.y - window.min.y + 1);
    std::vector<Sample> samples(width * height);
    Imf::FrameBuffer frame;
    frame.insert(name, Imf::Slice::Make(type, samples.data(), window, sizeof(Sample),
                                        sizeof(Sample) * width));
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    return samples;
}

/// A crop of 5 x 4 pixels at (3, 2) of a frame of 10 x 8.
struct Picture {
    Film film{10, 8, {3, 2, 8, 6}};
    FilmLayers layers{PixelBox{3, 2, 8, 6}};
    std::size_t depth = layers.add("depth.Z", SampleType::Float);
    std::size_t albedo = layers.add("albedo.R", SampleType::Half);
    std::size_t id = layers.add("id.object", SampleType::Uint);

    Picture() {
        for (int y = 2; y < 6; ++y) {
            for (int x = 3; x < 8; ++x) {
                film.set(x, y, {0.1 * x, 0.25 * y, -1.0});
                layers.set(depth, x, y, 1e30 + x);
                layers.set(albedo, x, y, 0.3 + 0.01 * y);
                layers.set_whole(id, x, y, 4'000'000'000u + static_cast<std::uint32_t>(10 * y + x));
            }
        }
        layers.set(depth, 3, 2, std::numeric_limits<double>::infinity());
    }
};

TEST(ExrLayers, TheLibraryReadsBackEveryChannelWithItsTypeAndPlace) {
    const Picture picture;
    const std::vector<std::byte> bytes =
        encode_exr_layers(picture.film, picture.layers,
                          {.full_float = false, .metadata = {{"note", "gr\xc3\xbc\xc3\x9f"}}});
    Bytes stream(bytes);
    Imf::InputFile file(stream, 0);
    const Imf::Header& header = file.header();
    EXPECT_EQ(header.dataWindow(), Imath::Box2i({3, 2}, {7, 5}));
    EXPECT_EQ(header.displayWindow(), Imath::Box2i({0, 0}, {9, 7}));
    EXPECT_EQ(header.compression(), Imf::ZIP_COMPRESSION);
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("note").value(), "gr\xc3\xbc\xc3\x9f");
    const auto type = [&](const char* name) { return header.channels()[name].type; };
    EXPECT_EQ(type("R"), Imf::HALF);
    EXPECT_EQ(type("depth.Z"), Imf::FLOAT);
    EXPECT_EQ(type("albedo.R"), Imf::HALF);
    EXPECT_EQ(type("id.object"), Imf::UINT);

    const auto green = read_channel<float>(file, "G", Imf::FLOAT);
    const auto depth = read_channel<float>(file, "depth.Z", Imf::FLOAT);
    const auto albedo = read_channel<float>(file, "albedo.R", Imf::FLOAT);
    const auto id = read_channel<std::uint32_t>(file, "id.object", Imf::UINT);
    for (int y = 2; y < 6; ++y) {
        for (int x = 3; x < 8; ++x) {
            const auto i = static_cast<std::size_t>(5 * (y - 2) + (x - 3));
            EXPECT_EQ(green[i], 0.25f * static_cast<float>(y));
            EXPECT_EQ(id[i], 4'000'000'000u + static_cast<std::uint32_t>(10 * y + x));
            EXPECT_NEAR(albedo[i], 0.3 + 0.01 * y, 2e-4);
            EXPECT_EQ(depth[i], i == 0 ? std::numeric_limits<float>::infinity()
                                       : static_cast<float>(1e30 + x));
        }
    }
}

TEST(ExrLayers, NumbersBeyondTheRangeOfHalfAreItsLargest) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const bool full_float : {false, true}) {
        Picture picture;
        picture.film.set(3, 2, {70000, -1e30, kInfinity});
        picture.layers.set(picture.albedo, 3, 2, 1e6);
        picture.layers.set(picture.albedo, 4, 2, -kInfinity);
        const auto bytes =
            encode_exr_layers(picture.film, picture.layers, {.full_float = full_float});
        Bytes stream(bytes);
        Imf::InputFile file(stream, 0);
        EXPECT_EQ(read_channel<float>(file, "R", Imf::FLOAT)[0], full_float ? 70000.0f : 65504.0f);
        EXPECT_EQ(read_channel<float>(file, "G", Imf::FLOAT)[0], full_float ? -1e30f : -65504.0f);
        EXPECT_EQ(read_channel<float>(file, "B", Imf::FLOAT)[0], kInfinity);
        const auto albedo = read_channel<float>(file, "albedo.R", Imf::FLOAT);
        EXPECT_EQ(albedo[0], 65504.0f);
        EXPECT_EQ(albedo[1], -kInfinity);
    }
}

TEST(ExrLayers, FullFloatIsOnlyAboutTheBeauty) {
    const Picture picture;
    const std::vector<std::byte> bytes =
        encode_exr_layers(picture.film, picture.layers, {.full_float = true});
    Bytes stream(bytes);
    Imf::InputFile file(stream, 0);
    EXPECT_EQ(file.header().channels()["R"].type, Imf::FLOAT);
    EXPECT_EQ(file.header().channels()["albedo.R"].type, Imf::HALF);
    EXPECT_EQ(read_channel<float>(file, "R", Imf::FLOAT)[1], static_cast<float>(0.1 * 4));
}

TEST(ExrLayers, OurOwnReaderFindsTheBeautyAmongTheLayers) {
    const Picture picture;
    const auto bytes = encode_exr_layers(picture.film, picture.layers, {.full_float = true});
    const Image image =
        decode_image({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "layers.exr");
    EXPECT_EQ(image.channels, 3);
    EXPECT_EQ(image.width, 10);
    EXPECT_EQ(image.height, 8);
    EXPECT_EQ(image.held.x0, 3);
    EXPECT_EQ(image.held.y0, 2);
    EXPECT_EQ(held_part(image).samples, picture.film.to_image().samples);
}

/// Output stream for the OpenEXR library.
class Written final : public Imf::OStream {
  public:
    Written() : Imf::OStream("test") {}
    void write(const char source[], int count) override {
        bytes.resize(std::max(bytes.size(), at_ + static_cast<std::size_t>(count)));
        std::memcpy(bytes.data() + at_, source, static_cast<std::size_t>(count));
        at_ += static_cast<std::size_t>(count);
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t position) override { at_ = position; }
    std::string bytes;

  private:
    std::size_t at_ = 0;
};

/// A file of parts of 2 x 1 pixels: part k has the channels of `parts[k]`, all of value k + 1.
std::string file_of_parts(const std::vector<std::vector<const char*>>& parts) {
    std::vector<Imf::Header> headers;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        Imf::Header header(2, 1);
        header.setName("part" + std::to_string(k));
        header.setType(Imf::SCANLINEIMAGE);
        for (const char* channel : parts[k]) header.channels().insert(channel, {Imf::FLOAT});
        headers.push_back(header);
    }
    Written stream;
    {
        Imf::MultiPartOutputFile file(stream, headers.data(), int(headers.size()));
        for (std::size_t k = 0; k < parts.size(); ++k) {
            std::vector<float> samples(2, float(k + 1));
            Imf::FrameBuffer frame;
            for (const char* channel : parts[k]) {
                frame.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&samples[0]),
                                                 sizeof(float), 0));
            }
            Imf::OutputPart part(file, int(k));
            part.setFrameBuffer(frame);
            part.writePixels(1);
        }
    }
    return stream.bytes;
}

TEST(ExrParts, ThePartWithColoursIsRead) {
    using Parts = std::vector<std::vector<const char*>>;
    const auto read = [](const Parts& parts) {
        const Image image = decode_image(file_of_parts(parts), "parts.exr");
        return std::pair(image.channels, image.samples.front());
    };
    EXPECT_EQ(read({{"Z"}, {"R", "G", "B"}}), std::pair(3, 2.0f));
    EXPECT_EQ(read({{"left.R", "left.G", "left.B"}, {"Y"}, {"R", "G", "B", "A"}}),
              std::pair(4, 3.0f));
    EXPECT_EQ(read({{"Z"}, {"id"}, {"Y", "A"}}), std::pair(2, 3.0f));
    EXPECT_EQ(read({{"Z"}, {"id"}}), std::pair(1, 1.0f));
}

/// A file of a deep part of colours without samples, and of a flat part after it, of 0.5.
std::string deep_and_flat(bool flat) {
    std::vector<Imf::Header> headers(flat ? 2 : 1, Imf::Header(2, 1));
    headers[0].setName("deep");
    headers[0].setType(Imf::DEEPSCANLINE);
    headers[0].compression() = Imf::ZIPS_COMPRESSION;
    for (Imf::Header& header : headers) {
        for (const char* name : {"R", "G", "B"}) header.channels().insert(name, Imf::FLOAT);
    }
    Written stream;
    if (flat) {
        headers[1].setName("flat");
        headers[1].setType(Imf::SCANLINEIMAGE);
    }
    Imf::MultiPartOutputFile file(stream, headers.data(), int(headers.size()));
    std::vector<unsigned> counts(2, 0);
    std::vector<float*> none(2, nullptr);
    Imf::DeepFrameBuffer deep;
    deep.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()),
                                           sizeof(unsigned), 2 * sizeof(unsigned)));
    for (const char* name : {"R", "G", "B"}) {
        deep.insert(name, Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(none.data()),
                                         sizeof(float*), 2 * sizeof(float*), sizeof(float)));
    }
    Imf::DeepScanLineOutputPart deep_part(file, 0);
    deep_part.setFrameBuffer(deep);
    deep_part.writePixels(1);
    if (flat) {
        std::vector<float> values(2, 0.5f);
        Imf::FrameBuffer frame;
        for (const char* name : {"R", "G", "B"}) {
            frame.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()),
                                          sizeof(float), 2 * sizeof(float)));
        }
        Imf::OutputPart part(file, 1);
        part.setFrameBuffer(frame);
        part.writePixels(1);
    }
    return stream.bytes;
}

TEST(ExrParts, AFlatPartIsReadBesideADeepOne) {
    const Image image = decode_image(deep_and_flat(true), "deep.exr");
    EXPECT_EQ(image.channels, 3);
    EXPECT_EQ(image.samples, std::vector<float>(6, 0.5f));
    try {
        (void)decode_image(deep_and_flat(false), "deep.exr");
        ADD_FAILURE() << "a deep picture is read";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("deep EXR"), std::string::npos) << error.what();
    }
}

TEST(ExrLayers, TheBeautyIsThatOfAPictureWithoutLayers) {
    const Picture picture;
    const auto with_layers = encode_exr_layers(picture.film, picture.layers, {});
    const auto alone = encode_image("exr", picture.film.to_image());
    const auto decode = [](const std::vector<std::byte>& bytes) {
        return decode_image({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "a.exr");
    };
    EXPECT_EQ(held_part(decode(with_layers)).samples, decode(alone).samples);
}

TEST(ExrLayers, ChannelsOfOneNameAndLayersOfAnotherCropAreRefused) {
    Picture picture;
    picture.layers.add("depth.Z", SampleType::Float);
    EXPECT_THROW((void)encode_exr_layers(picture.film, picture.layers, {}), Error);
    FilmLayers other(PixelBox{0, 0, 5, 4});
    other.add("depth.Z", SampleType::Float);
    EXPECT_THROW((void)encode_exr_layers(picture.film, other, {}), Error);
    EXPECT_THROW((void)encode_exr_layers(picture.film, FilmLayers{}, {.metadata = {{"", "x"}}}),
                 Error);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
