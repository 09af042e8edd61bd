/// Damaged and hostile images: an error that names the file, no crash, no hang, bounded memory.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>
#include <jpeglib.h>
#include <sys/resource.h>

#include "alhazen/base/file.h"
#include "support/test_data.h"
#include "unit/imaging/test_images.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

namespace fs = std::filesystem;
using testing::as_string;
using testing::error_of;

struct Sample {
    std::string name, bytes;
};

/// A file of every format that can be written, with long runs and noise.
std::vector<Sample> samples() {
    Image image = testing::random_image(41, 19, 3, 0, 1, 1);
    std::fill_n(image.samples.begin(), 1000, 0.5f);
    std::vector<Sample> result;
    for (const char* suffix : {"png", "jpg", "exr", "hdr", "pfm"}) {
        result.push_back({std::string("sample.") + suffix, as_string(encode_image(suffix, image))});
    }
    return result;
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ALHAZEN_MEMORY_IS_WATCHED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define ALHAZEN_MEMORY_IS_WATCHED 1
#endif
#endif
#ifndef ALHAZEN_MEMORY_IS_WATCHED
#define ALHAZEN_MEMORY_IS_WATCHED 0
#endif

/// Sanitizers touch memory that is only reserved.
constexpr bool kMemoryIsWatched = ALHAZEN_MEMORY_IS_WATCHED != 0;

bool is_bad_data(std::optional<ErrorKind> kind) {
    return kind == ErrorKind::Scene || kind == ErrorKind::Resource;
}

TEST(HostileImages, EveryTruncationIsAnErrorThatNamesTheFile) {
    for (const Sample& sample : samples()) {
        // A JPEG may lack the marker of its end, of two bytes.
        const std::size_t least = sample.bytes.size() - (sample.name == "sample.jpg" ? 2 : 0);
        for (std::size_t size = 0; size < least; size += size < 200 ? 1 : 17) {
            try {
                (void)decode_image(std::string_view(sample.bytes).substr(0, size), sample.name);
                // Reached only if a truncated file decodes.
                ADD_FAILURE() << sample.name << " cut to " << size << " of " << sample.bytes.size();
            } catch (const Error& error) {
                ASSERT_EQ(error.kind(), ErrorKind::Scene) << error.what();
                ASSERT_EQ(error.location().file, sample.name) << error.what();
            }
        }
    }
}

/// A JPEG of several scans: progressive, or one for each component.
std::string jpeg_of_scans(bool progressive) {
    jpeg_error_mgr errors;
    jpeg_compress_struct cinfo{};
    cinfo.err = jpeg_std_error(&errors);
    jpeg_create_compress(&cinfo);
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&cinfo, &bytes, &size);
    cinfo.image_width = 40;
    cinfo.image_height = 24;
    cinfo.input_components = 3;
    cinfo.in_color_space = JCS_RGB;
    jpeg_set_defaults(&cinfo);
    const jpeg_scan_info scans[] = {{1, {0, 0, 0, 0}, 0, 63, 0, 0},
                                    {1, {1, 0, 0, 0}, 0, 63, 0, 0},
                                    {1, {2, 0, 0, 0}, 0, 63, 0, 0}};
    if (progressive) {
        jpeg_simple_progression(&cinfo);
    } else {
        cinfo.scan_info = scans;
        cinfo.num_scans = 3;
    }
    jpeg_start_compress(&cinfo, TRUE);
    std::mt19937 random(3);
    for (int y = 0; y < 24; ++y) {
        std::array<JSAMPLE, 120> samples;
        for (JSAMPLE& sample : samples) sample = JSAMPLE(random());
        JSAMPROW row = samples.data();
        jpeg_write_scanlines(&cinfo, &row, 1);
    }
    jpeg_finish_compress(&cinfo);
    jpeg_destroy_compress(&cinfo);
    std::string result(reinterpret_cast<const char*>(bytes), size);
    std::free(bytes);
    return result;
}

TEST(HostileImages, JpegsThatEndBetweenScansAreErrors) {
    for (const bool progressive : {true, false}) {
        const std::string bytes = jpeg_of_scans(progressive);
        const std::vector<float> whole = decode_image(bytes, "a.jpg").samples;
        const std::string without = bytes.substr(0, bytes.size() - 2);
        EXPECT_EQ(decode_image(without, "a.jpg").samples, whole);
        std::size_t scans = 0;
        for (std::size_t size = 0; size + 2 < bytes.size(); ++size) {
            scans += bytes.compare(size, 2, "\xff\xda") == 0;
            const std::string part = bytes.substr(0, size);
            ASSERT_EQ(error_of([&] { (void)decode_image(part, "a.jpg"); }), ErrorKind::Scene)
                << size << " of " << bytes.size();
        }
        EXPECT_GE(scans, 3u);
    }
}

TEST(HostileImages, ChangedBytesNeverDoHarm) {
    std::mt19937 random(7);
    const ImageLimits limits{.max_side = 4096, .max_pixels = 1 << 22};
    for (const Sample& sample : samples()) {
        for (int i = 0; i < 1500; ++i) {
            std::string bytes = sample.bytes;
            const std::size_t reach =
                i % 2 == 0 ? std::min<std::size_t>(400, bytes.size()) : bytes.size();
            for (unsigned k = 0; k <= random() % 4; ++k) {
                bytes[random() % reach] = char(random());
            }
            const auto kind = error_of([&] { (void)decode_image(bytes, sample.name, limits); });
            ASSERT_TRUE(!kind || is_bad_data(kind)) << sample.name << " case " << i;
        }
    }
}

TEST(HostileImages, SizesBeyondTheLimitsAreResourceErrors) {
    for (const Sample& sample : samples()) {
        const auto kind_at = [&](ImageLimits limits) {
            return error_of([&] { (void)decode_image(sample.bytes, sample.name, limits); });
        };
        EXPECT_EQ(kind_at({.max_side = 41, .max_pixels = 41 * 19}), std::nullopt) << sample.name;
        EXPECT_EQ(kind_at({.max_side = 40, .max_pixels = 41 * 19}), ErrorKind::Resource)
            << sample.name;
        EXPECT_EQ(kind_at({.max_side = 41, .max_pixels = 41 * 19 - 1}), ErrorKind::Resource)
            << sample.name;
    }
}

TEST(HostileImages, MemoryBeyondTheLimitIsRefusedBeforeItIsTaken) {
    for (const Sample& sample : samples()) {
        const StoredImage image = decode_stored_image(sample.bytes, sample.name);
        const auto kind_at = [&](std::uint64_t max_bytes) -> std::optional<ErrorKind> {
            try {
                (void)decode_stored_image(sample.bytes, sample.name, {.max_bytes = max_bytes});
                return std::nullopt;
            } catch (const ImageMemoryExceeded& error) {
                return error.kind();
            }
        };
        EXPECT_EQ(kind_at(image.memory_bytes() - 1), ErrorKind::Resource) << sample.name;
        // Decoders need little memory in addition to the samples of a small image.
        EXPECT_EQ(kind_at(image.memory_bytes() + (1 << 16)), std::nullopt) << sample.name;
    }
}

TEST(HostileImages, HeadersThatLieAboutTheSizeCostNoMemory) {
    const auto peak_kib = [] {
        rusage usage{};
        ::getrusage(RUSAGE_SELF, &usage);
        return usage.ru_maxrss;
    };
    const long before = peak_kib();
    // The sizes are accepted, then the data end.
    const ImageLimits limits{.max_pixels = std::uint64_t{1} << 28,
                             .max_bytes = std::uint64_t{1} << 34};
    const std::string size = "-Y 16384 +X 16384\n";
    const std::string hdr = "#?RADIANCE\n\n" + size + std::string(100, 'x');
    const std::string pfm = "PF\n16384 16384\n-1\n" + std::string(100, 'x');
    EXPECT_EQ(error_of([&] { (void)decode_image(hdr, "lie.hdr", limits); }), ErrorKind::Scene);
    EXPECT_EQ(error_of([&] { (void)decode_image(pfm, "lie.pfm", limits); }), ErrorKind::Scene);
    for (Sample sample : samples()) {
        // Replaces sides of 41 and 19, or the corners 40 and 18 of a window, by 16384 (0x4000) or
        // slightly less.
        const auto change = [&](const std::string& from, const std::string& to) {
            const std::size_t at = sample.bytes.find(from);
            ASSERT_NE(at, std::string::npos) << sample.name;
            sample.bytes.replace(at, from.size(), to);
        };
        if (sample.name == "sample.exr") {
            const std::string start("dataWindow\0box2i\0\x10\0\0\0\0\0\0\0\0\0\0\0", 29);
            change(start + std::string("\x28\0\0\0\x12\0", 6),
                   start + std::string("\0\x3f\0\0\0\x3f", 6));
        } else if (sample.name == "sample.jpg") {
            change(std::string("\x08\0\x13\0\x29", 5), std::string("\x08\x40\0\x40\0", 5));
        } else {
            continue;
        }
        EXPECT_EQ(error_of([&] { (void)decode_image(sample.bytes, sample.name, limits); }),
                  ErrorKind::Scene)
            << sample.name;
    }
    if (!kMemoryIsWatched) {
        EXPECT_LT(peak_kib() - before, 200 * 1024);
    }
}

TEST(HostileImages, TheCorpusIsReadButForTheBadFilesThatOnceDidHarm) {
    int files = 0;
    for (const char* format : {"png", "jpeg", "bmp", "exr", "hdr", "pfm", "tga"}) {
        const fs::path folder = fs::path(testing::source_folder() / "tests/corpus") / format;
        if (!fs::exists(folder)) continue;
        for (const auto& entry : fs::directory_iterator(folder)) {
            const std::string name = entry.path().filename().string();
            const auto kind = error_of([&] { (void)read_image(entry.path()); });
            if (name.starts_with("bad_")) {
                EXPECT_TRUE(is_bad_data(kind)) << name;
            } else {
                EXPECT_EQ(kind, std::nullopt) << name;
            }
            ++files;
        }
    }
    EXPECT_GT(files, 20);
}

struct Counts {
    int read = 0, refused = 0;
};

/// Decodes all files below `folder`, each within a time limit.
Counts decode_all(const fs::path& folder) {
    Counts counts;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        const std::string bytes = read_file(entry.path());
        const auto start = std::chrono::steady_clock::now();
        const auto kind =
            error_of([&] { (void)decode_image(bytes, entry.path().filename().string()); });
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        EXPECT_TRUE(!kind || is_bad_data(kind)) << entry.path();
        EXPECT_LT(seconds.count(), 20) << entry.path();
        ++(kind ? counts.refused : counts.read);
    }
    return counts;
}

TEST(HostileImages, FilesThatBrokeOtherReadersAreHarmless) {
    ALHAZEN_NEEDS_DATA("hostile");
    const fs::path hostile = testing::test_data() / "hostile";
    int files = 0;
    for (const char* folder : {"exr", "oiio", "mitsuba/bitmap", "png"}) {
        if (!fs::exists(hostile / folder)) continue;
        const Counts counts = decode_all(hostile / folder);
        files += counts.read + counts.refused;
    }
    EXPECT_GT(files, 100);
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    if (!kMemoryIsWatched) {
        EXPECT_LT(usage.ru_maxrss, 256 * 1024) << "KiB";
    }
}

TEST(HostileImages, TheGoodPngFilesOfTheSuiteAreReadAndTheCorruptAreNot) {
    ALHAZEN_NEEDS_DATA("hostile/png/pngsuite/corrupt");
    const fs::path suite = testing::test_data() / "hostile/png/pngsuite";
    for (const char* folder : {"primary", "16bit"}) {
        const Counts counts = decode_all(suite / folder);
        EXPECT_EQ(counts.refused, 0) << folder;
        EXPECT_GT(counts.read, 0) << folder;
    }
    const Counts corrupt = decode_all(suite / "corrupt");
    EXPECT_EQ(corrupt.read, 0);
    EXPECT_GT(corrupt.refused, 0);
}

TEST(HostileImages, ThePngFilesOfTheSuiteShowWhatTheirReferencesShow) {
    ALHAZEN_NEEDS_DATA("hostile/png/pngsuite/primary_check");
    const fs::path suite = testing::test_data() / "hostile/png/pngsuite";
    int compared = 0;
    for (const auto& entry : fs::directory_iterator(suite / "primary")) {
        const fs::path name = entry.path().filename();
        const StoredImage read = read_stored_image(entry.path());
        const StoredImage reference = read_stored_image(suite / "primary_check" / name);
        ASSERT_EQ(read.width, reference.width) << name;
        ASSERT_EQ(read.height, reference.height) << name;
        // Compared as colours: a reference may have another colour type.
        const std::size_t pixels = std::size_t(read.width) * std::size_t(read.height);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < pixels; ++i) {
            wrong += !(read.pixel(i, false) == reference.pixel(i, false));
        }
        EXPECT_EQ(wrong, 0u) << name << " of " << pixels;
        ++compared;
    }
    EXPECT_GT(compared, 30);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
