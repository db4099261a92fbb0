#include "components/recordings/ZipEntry.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "components/recordings/RecordingReader.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::recordings {
namespace {

namespace zip {
constexpr uint32_t magic = 0x04034B50;
constexpr size_t header = 30, flags = 6, method = 8, checksum = 14, packed = 18, size = 22, name = 26, extra = 28;
constexpr uint16_t stored = 0, deflated = 8, sizes_follow = 8;
constexpr size_t block = size_t{1} << 16;
}  // namespace zip

}  // namespace

struct ZipEntry::Source {
    std::filesystem::path path;
    std::ifstream file;
    std::string name, diagnostic;
    uint16_t method = 0;
    bool has_sizes = false;
    uint32_t checksum = 0;
    uint64_t packed_left = 0;  ///< Unread bytes of the entry, if sizes are known.

    std::vector<char> packed, window;
    size_t begin = 0;  ///< Offset of the next byte in `window`.
    uint64_t at = 0;
    bool ended = false;
    uLong sum = crc32(0, nullptr, 0);
    z_stream stream{};

    ~Source() { inflateEnd(&stream); }

    /** Reads the header at the file's position; returns false if there is none. */
    bool readHeader() {
        char bytes[zip::header];
        if (!file.read(bytes, sizeof bytes) || field<uint32_t>(bytes, 0) != zip::magic) return false;
        name.resize(field<uint16_t>(bytes, zip::name));
        file.read(name.data(), static_cast<std::streamsize>(name.size()));
        std::ranges::replace_if(
            name, [](char letter) { return letter < ' ' || letter > '~'; }, '?');  // for messages
        file.seekg(field<uint16_t>(bytes, zip::extra), std::ios::cur);
        method = field<uint16_t>(bytes, zip::method);
        checksum = field<uint32_t>(bytes, zip::checksum);
        packed_left = field<uint32_t>(bytes, zip::packed);
        const bool is_long = packed_left == 0xFFFFFFFF || field<uint32_t>(bytes, zip::size) == 0xFFFFFFFF;
        has_sizes = !(field<uint16_t>(bytes, zip::flags) & zip::sizes_follow) && !is_long;
        return !file.fail();
    }
    [[noreturn]] void fail(const std::string& why) const { throw types::ConfigError(path.string(), name, why); }

    void end(const std::string& why) {
        ended = true;
        if (diagnostic.empty()) diagnostic = why;
    }
    /** Adds bytes to the window, or ends. */
    void fill() {
        if (begin > 0) window.erase(window.begin(), window.begin() + static_cast<std::ptrdiff_t>(begin));
        begin = 0;
        const size_t before = window.size();
        method == zip::stored ? copy() : unpack();
        sum = crc32(sum, reinterpret_cast<const Bytef*>(window.data() + before),
                    static_cast<uInt>(window.size() - before));
        if (ended && has_sizes && diagnostic.empty() && sum != checksum)
            diagnostic = "its checksum is wrong: some of its bytes are";
    }
    /** Returns the next packed bytes; none at the end of the archive or the entry. */
    size_t readPacked(char* to, size_t size) {
        if (has_sizes) size = static_cast<size_t>(std::min<uint64_t>(size, packed_left));
        file.read(to, static_cast<std::streamsize>(size));
        const auto read = static_cast<size_t>(file.gcount());
        packed_left -= has_sizes ? read : 0;
        return read;
    }
    void copy() {
        const size_t before = window.size();
        window.resize(before + zip::block);
        const size_t read = readPacked(window.data() + before, zip::block);
        window.resize(before + read);
        if (packed_left == 0)
            end("");
        else if (read == 0)
            end("it is cut off by the end of the archive");
    }
    void unpack() {
        if (stream.avail_in == 0) {
            packed.resize(zip::block);
            stream.avail_in = static_cast<uInt>(readPacked(packed.data(), packed.size()));
            stream.next_in = reinterpret_cast<Bytef*>(packed.data());
            if (stream.avail_in == 0) return end("it is cut off by the end of the archive");
        }
        const size_t before = window.size();
        window.resize(before + zip::block);
        stream.next_out = reinterpret_cast<Bytef*>(window.data() + before);
        stream.avail_out = static_cast<uInt>(zip::block);
        const int result = inflate(&stream, Z_NO_FLUSH);
        window.resize(before + zip::block - stream.avail_out);
        if (result == Z_STREAM_END)
            end("");
        else if (result != Z_OK && result != Z_BUF_ERROR)
            end(fmt::format("it is damaged behind byte {}", at + window.size()));
    }
};

ZipEntry::ZipEntry(const std::filesystem::path& path, const std::string& ending) : source_(std::make_unique<Source>()) {
    Source& source = *source_;
    source.path = path;
    source.file.open(path, std::ios::binary);
    while (source.readHeader()) {
        if (source.name.ends_with(ending)) {
            if (source.method != zip::stored && source.method != zip::deflated)
                source.fail(fmt::format("is packed by method {}; it may be 0 or 8", source.method));
            if (source.method == zip::stored && !source.has_sizes) source.fail("has no size in the archive");
            inflateInit2(&source.stream, -MAX_WBITS);  // without a header of zlib's
            return;
        }
        if (!source.has_sizes) source.fail("has no size in the archive, so files behind it cannot be found");
        source.file.seekg(static_cast<std::streamoff>(source.packed_left), std::ios::cur);
    }
    source.name.clear();
    source.fail(fmt::format("is an archive without a file whose name ends in {}", ending));
}

ZipEntry::~ZipEntry() = default;

const std::string& ZipEntry::name() const { return source_->name; }

std::span<const char> ZipEntry::peek(size_t size) {
    Source& source = *source_;
    while (!source.ended && source.window.size() - source.begin < size) source.fill();
    return std::span<const char>(source.window)
        .subspan(source.begin)
        .first(std::min(size, source.window.size() - source.begin));
}

void ZipEntry::skip(size_t size) {
    Source& source = *source_;
    const size_t passed = std::min(size, source.window.size() - source.begin);
    source.begin += passed;
    source.at += passed;
}

uint64_t ZipEntry::at() const { return source_->at; }

const std::string& ZipEntry::diagnostic() const { return source_->diagnostic; }

}  // namespace insonify::recordings
