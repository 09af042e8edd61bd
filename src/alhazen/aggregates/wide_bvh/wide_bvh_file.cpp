#include "alhazen/aggregates/wide_bvh/wide_bvh_file.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <memory>
#include <string>
#include <type_traits>

#include "alhazen/aggregates/wide_bvh/table_fingerprint.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_check.h"
#include "alhazen/base/checksum.h"
#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/base/mapped_file.h"

namespace alhazen {
namespace {

constexpr std::size_t kHeaderBytes = 512;
constexpr std::size_t kAlignment = 256;
constexpr std::size_t kMaxArrays = 16;
constexpr char kMagic[8] = {'A', 'L', 'H', 'Z', 'B', 'V', 'H', '\n'};
static_assert(alignof(WideNode) <= kAlignment && alignof(TriangleBlock) <= kAlignment &&
              alignof(SphereBlock) <= kAlignment && alignof(FrustumBlock) <= kAlignment &&
              alignof(BoxBlock) <= kAlignment);

/// The beginning of a file. The rest of its 512 bytes is zero, except for the checksum at their
/// end.
struct Header {
    char magic[8];
    std::uint32_t byte_order;
    std::uint32_t version;
    std::uint64_t file_bytes;
    std::uint64_t fingerprint;
    std::uint64_t count[kMaxArrays];          ///< [array] number of elements
    std::uint32_t element_bytes[kMaxArrays];  ///< [array] size of an element; 0: no such array
    std::uint32_t frame_bytes;
    std::uint32_t node_width, block_width;
    NodeRef root;
    std::uint32_t empty;
    std::int32_t depth;
    std::uint32_t precision;  ///< a Precision
    LocalFrame frame;
    Box3 box;
};
constexpr std::size_t kChecksumAt = kHeaderBytes - sizeof(std::uint64_t);
static_assert(sizeof(Header) <= kChecksumAt && std::is_trivially_copyable_v<Header>);
using HeaderBytes = std::array<std::byte, kHeaderBytes>;

std::size_t aligned(std::size_t bytes) {
    return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
    throw Error(ErrorKind::File, why, {path.string(), 0, 0});
}

/// The parts of a header that identify the build, for empty arrays.
Header header_of_this_build() {
    Header header;
    std::memset(static_cast<void*>(&header), 0, sizeof(header));
    std::memcpy(header.magic, kMagic, sizeof(kMagic));
    header.byte_order = 0x01020304;
    header.version = kWideBvhFileVersion;
    header.frame_bytes = sizeof(LocalFrame);
    header.block_width = kBlockWidth;
    const WideBvhLayout none;
    std::size_t i = 0;
    for_each_array(none, [&](const auto& array) {
        using Element = typename std::remove_cvref_t<decltype(array)>::value_type;
        static_assert(std::is_trivially_copyable_v<Element>);
        header.element_bytes[i++] = sizeof(Element);
    });
    header.element_bytes[i] = sizeof(PrimitiveId);  // the unbounded ones come last
    return header;
}

/// True for a width in kNodeWidths.
bool is_node_width(std::uint32_t width) {
    return std::find(std::begin(kNodeWidths), std::end(kNodeWidths), width) !=
           std::end(kNodeWidths);
}

/// Throws Error (File) unless the header is of this build and the file has the size that it states.
void check_header(const std::filesystem::path& path, const Header& header, std::size_t file_bytes) {
    const Header own = header_of_this_build();
    if (std::memcmp(header.magic, own.magic, sizeof(own.magic)) != 0) {
        refuse(path, "is no stored tree");
    }
    if (header.byte_order != own.byte_order) {
        refuse(path, "the tree was stored on a machine of the other byte order");
    }
    if (header.version != own.version) {
        refuse(path, "the tree is of format version " + std::to_string(header.version) +
                         ", expected version " + std::to_string(own.version));
    }
    if (header.file_bytes != file_bytes) {
        refuse(path, "the file has " + std::to_string(file_bytes) + " bytes, expected " +
                         std::to_string(header.file_bytes));
    }
    if (header.frame_bytes != own.frame_bytes || !is_node_width(header.node_width) ||
        header.block_width != own.block_width ||
        std::memcmp(header.element_bytes, own.element_bytes, sizeof(own.element_bytes)) != 0) {
        refuse(path, "the tree was stored by a build with other nodes or leaves");
    }
    // Kernels in single precision exist for one width.
    if (header.precision > static_cast<std::uint32_t>(Precision::Fast) ||
        (header.precision != static_cast<std::uint32_t>(Precision::Robust) &&
         header.node_width != BuildOptions{}.width)) {
        refuse(path, "the tree has a precision that this build lacks");
    }
    std::size_t expected = kHeaderBytes;
    for (std::size_t i = 0; i < kMaxArrays; ++i) {
        const std::size_t room = file_bytes - expected;
        // A product that fits cannot overflow.
        if (header.count[i] != 0 &&
            (header.element_bytes[i] == 0 || header.count[i] > room / header.element_bytes[i])) {
            refuse(path, "the arrays of the tree are longer than its file");
        }
        const std::size_t bytes = aligned(header.count[i] * header.element_bytes[i]);
        if (bytes > room) refuse(path, "the arrays of the tree are longer than its file");
        expected += bytes;
    }
    if (expected != file_bytes) refuse(path, "the file is longer than the tree in it");
}

/// False if the byte of the frame's flag is that of no bool, which must not be read.
bool has_flag(std::span<const std::byte> file) {
    constexpr std::size_t kFlagAt = offsetof(Header, frame) + offsetof(LocalFrame, usual);
    static_assert(sizeof(LocalFrame::usual) == 1);
    return file[kFlagAt] <= std::byte{1};
}

/// Returns the arrays of a mapped file one after another.
class ArrayReader {
  public:
    ArrayReader(std::shared_ptr<const MappedFile> file, const Header& header)
        : file_(std::move(file)), header_(header) {}

    template <class T>
    std::span<const T> next() {
        const std::size_t count = header_.count[array_++];
        const std::byte* first = file_->bytes().data() + at_;
        at_ += aligned(count * sizeof(T));
        return {reinterpret_cast<const T*>(first), count};
    }

  private:
    std::shared_ptr<const MappedFile> file_;
    const Header& header_;
    std::size_t array_ = 0, at_ = kHeaderBytes;
};

/// The checksum of a file: of the header except its last word, which holds it, and of all
/// `kMaxArrays` arrays.
std::uint64_t file_checksum(const HeaderBytes& header,
                            std::span<const std::span<const std::byte>> arrays) {
    Checksum sum;
    sum.add(std::span<const std::byte>(header).first(kChecksumAt));
    for (const std::span<const std::byte> array : arrays) sum.add(array);
    return sum.value();
}

/// Throws Error (File) unless every byte of the file is as written.
void check_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes,
                 const Header& header) {
    std::vector<std::span<const std::byte>> arrays;
    std::size_t at = kHeaderBytes;
    bool damaged = false;
    for (std::size_t i = 0; i < kMaxArrays; ++i) {
        const std::size_t size = header.count[i] * header.element_bytes[i];
        arrays.push_back(bytes.subspan(at, size));
        for (const std::byte b : bytes.subspan(at + size, aligned(size) - size)) {
            damaged = damaged || b != std::byte{0};
        }
        at += aligned(size);
    }
    HeaderBytes header_bytes;
    std::memcpy(header_bytes.data(), bytes.data(), kHeaderBytes);
    std::uint64_t stored = 0;
    std::memcpy(&stored, bytes.data() + kChecksumAt, sizeof(stored));
    damaged = damaged || stored != file_checksum(header_bytes, arrays);
    if (damaged) refuse(path, "the stored tree is damaged: its checksum does not match");
}

}  // namespace

void save_wide_bvh(const std::filesystem::path& path, const WideBvhLayout& layout, const Box3& box,
                   const std::vector<PrimitiveId>& unbounded, const PrimitiveTable& table,
                   Precision precision) {
    Header header = header_of_this_build();
    header.fingerprint = table_fingerprint(table);
    header.node_width = layout.tree.width;
    header.root = layout.tree.empty ? NodeRef::node(0) : layout.tree.root;
    header.empty = layout.tree.empty;
    header.depth = layout.tree.depth;
    header.precision = static_cast<std::uint32_t>(precision);
    header.frame = layout.frame;
    // The padding after the flag was copied with undefined content.
    constexpr std::size_t kGap = offsetof(LocalFrame, usual) + sizeof(LocalFrame::usual);
    std::memset(reinterpret_cast<std::byte*>(&header.frame) + kGap, 0,
                offsetof(LocalFrame, slack) - kGap);
    header.box = box;
    std::vector<std::span<const std::byte>> arrays;
    const auto add = [&](const auto& array) {
        header.count[arrays.size()] = array.size();
        arrays.push_back(std::as_bytes(std::span(array)));
    };
    for_each_array(layout, add);
    add(unbounded);

    constexpr std::array<std::byte, kAlignment> kZeros{};
    HeaderBytes header_bytes{};
    std::vector<std::span<const std::byte>> pieces{header_bytes};
    header.file_bytes = kHeaderBytes;
    for (const std::span<const std::byte> array : arrays) {
        pieces.push_back(array);
        pieces.push_back(std::span(kZeros).first(aligned(array.size()) - array.size()));
        header.file_bytes += aligned(array.size());
    }
    std::memcpy(header_bytes.data(), &header, sizeof(header));
    arrays.resize(kMaxArrays);
    const std::uint64_t sum = file_checksum(header_bytes, arrays);
    std::memcpy(header_bytes.data() + kChecksumAt, &sum, sizeof(sum));
    write_file_atomically(path, pieces);
}

StoredWideBvh load_wide_bvh(const std::filesystem::path& path, const PrimitiveTable& table) {
    const std::shared_ptr<const MappedFile> file = MappedFile::open(path);
    if (file->bytes().size() < kHeaderBytes) refuse(path, "is no stored tree: it is too short");
    Header header;
    std::memcpy(static_cast<void*>(&header), file->bytes().data(), sizeof(header));
    check_header(path, header, file->bytes().size());
    check_bytes(path, file->bytes(), header);
    if (header.fingerprint != table_fingerprint(table)) {
        refuse(path, "the tree was built over other geometry");
    }
    if (!has_flag(file->bytes())) refuse(path, "the stored tree is not sound: its frame is none");
    StoredWideBvh tree;
    tree.layout.frame = header.frame;
    tree.layout.tree.root = header.root;
    tree.layout.tree.empty = header.empty != 0;
    tree.layout.tree.depth = header.depth;
    tree.layout.tree.width = header.node_width;
    tree.box = header.box;
    tree.precision = static_cast<Precision>(header.precision);
    ArrayReader arrays(file, header);
    for_each_array(tree.layout, [&]<class T>(MappableVector<T>& array) {
        array = MappableVector<T>(arrays.next<T>(), file);
    });
    const std::span<const PrimitiveId> unbounded = arrays.next<PrimitiveId>();
    tree.unbounded.assign(unbounded.begin(), unbounded.end());
    const char* wrong = first_violation(tree.layout, table);
    for (const PrimitiveId id : tree.unbounded) {
        if (static_cast<std::uint32_t>(id) >= table.size())
            wrong = "an unbounded primitive is not there";
    }
    if (wrong != nullptr) refuse(path, std::string("the stored tree is not sound: ") + wrong);
    return tree;
}

}  // namespace alhazen
