#include "components/recordings/GlfFile.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
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

namespace {

namespace glf {
// Each record is a header and its data.
constexpr char mark = '*';
constexpr size_t stamp = 6, type = 14, device = 15, header = 21, head = header + 4;
constexpr int image_type = 0;
constexpr uint16_t end_mark = 0xDEDE, image_mark = 0xEFEF;
// Offsets in an image's record: numbers, samples, a bearing of 8 bytes for each beam, the tail.
constexpr size_t version = header + 4, start_range = header + 6, end_range = header + 10, start_bearing = header + 16,
                 end_bearing = header + 20, numbers = header + 28, compression = header + 24;
constexpr uint16_t max_version = 3, compression_since = 3;
constexpr int zlib = 0, none = 1, h264 = 2;
// Offsets in the tail.
constexpr size_t state = 0, modulation = 4, transmit_time = 12, ping_flags = 20, sound_speed = 22, platform = 30,
                 is_zoomed = 31, tail_mark = 32, tail_size = 34;
constexpr uint32_t inverted = 0xE000;
constexpr uint16_t high_frequency = 0x0101;  // bit 0 in the maker's header, bit 8 in its example
constexpr uint32_t max_beams = 4096, max_ranges = 65536;
constexpr size_t max_samples = size_t{1} << 25;
constexpr double epoch_s = 315532800;  // 1980, since 1970
}  // namespace glf

bool isKnownType(int type) { return type <= 5 || type == 98 || type == 99; }

/** Returns whether the bytes are the beginning of a record. */
bool beginsRecord(std::span<const char> head) {
    if (head.size() < glf::head || head[0] != glf::mark) return false;
    const double stamp = field<double>(head, glf::stamp);
    const int type = field<uint8_t>(head, glf::type);
    const bool is_image =
        field<uint16_t>(head, glf::header) == 1 && field<uint16_t>(head, glf::header + 2) == glf::image_mark;
    return isKnownType(type) && stamp >= 0 && stamp < 1e10 && (type != glf::image_type || is_image);
}

/** Returns the frequency by the maker's name of the model; 0 if unknown [kHz]. */
double geminiFrequency(int platform, uint16_t flags) {
    switch (platform) {
        case 1:  // 720is, ik, im, and the ik's three sectors of 360 degrees
        case 2:
        case 3:
        case 5:
        case 6:
        case 7: return 720;
        case 4:  // 1200ik, its NBI, 1200id, Micron 1200d
        case 8:
        case 9:
        case 10: return flags & glf::high_frequency ? 1200 : 720;
        default: return 0;
    }
}

}  // namespace

void GlfFile::failAt(size_t offset, const std::string& why) const {
    fail(fmt::format("{}, byte {}", entry_.name(), entry_.at() + offset), why);
}

bool GlfFile::endsHere(std::span<const char> head) {
    const bool has_end_mark = head.size() >= 2 && field<uint16_t>(head, 0) == glf::end_mark;
    if (head.size() >= glf::head && !has_end_mark) return false;
    if (!has_end_mark && !head.empty()) cut_off_record_ = entry_.at();
    return true;
}

GlfFile::Image GlfFile::getImage(std::span<const char> head) const {
    const auto version = field<uint16_t>(head, glf::version);
    if (version > glf::max_version)
        failAt(glf::version,
               fmt::format("the image is of version {}; only those up to {} are known", version, glf::max_version));
    Image image;
    image.start_range = field<uint32_t>(head, glf::start_range);
    image.end_range = field<uint32_t>(head, glf::end_range);
    if (image.start_range >= image.end_range || image.end_range > glf::max_ranges)
        failAt(glf::start_range, fmt::format("the ranges are {} to {}; they must ascend and be at most {}",
                                             image.start_range, image.end_range, glf::max_ranges));
    const auto first = field<uint32_t>(head, glf::start_bearing), last = field<uint32_t>(head, glf::end_bearing);
    if (first >= last || last - first > glf::max_beams)
        failAt(glf::start_bearing, fmt::format("the bearings are {} to {}; they must ascend and be at most {}", first,
                                               last, glf::max_beams));
    image.beams = last - first;
    if (image.allSamples() > glf::max_samples)
        failAt(glf::end_range, fmt::format("the image has {} beams of {} ranges; at most {} samples are read",
                                           image.beams, image.end_range, glf::max_samples));
    const bool has_compression = version >= glf::compression_since;
    const size_t size_at = glf::compression + (has_compression ? 2 : 0);
    image.packed_size = field<uint32_t>(head, size_at);
    image.compression = has_compression                        ? field<uint16_t>(head, glf::compression)
                        : image.packed_size == image.samples() ? glf::none
                                                               : glf::zlib;
    if (image.compression > glf::h264)
        failAt(glf::compression, fmt::format("the compression is {}; it may be 0 to 2", image.compression));
    if (image.packed_size > compressBound(image.allSamples()))
        failAt(size_at, fmt::format("the samples take {} bytes; {} beams of {} ranges take fewer", image.packed_size,
                                    image.beams, image.end_range));
    image.packed = size_at + 4;
    image.bearings = image.packed + image.packed_size;
    image.tail = image.bearings + size_t{image.beams} * sizeof(double);
    image.size = image.tail + glf::tail_size;
    return image;
}

std::vector<char> GlfFile::getSamples(std::span<const char> record, const Image& image) const {
    const std::span<const char> packed = record.subspan(image.packed, image.packed_size);
    std::vector<char> samples(packed.begin(), packed.end());
    if (image.compression == glf::zlib) {
        constexpr size_t max_ratio = 1032;  // max of deflate
        if (image.packed_size < image.samples() / max_ratio)
            failAt(image.packed,
                   fmt::format("{} bytes cannot hold the {} samples of {} beams and {} ranges", image.packed_size,
                               image.samples(), image.beams, image.end_range - image.start_range));
        samples.resize(image.allSamples());
        uLongf size = samples.size();
        const int result = uncompress(reinterpret_cast<Bytef*>(samples.data()), &size,
                                      reinterpret_cast<const Bytef*>(packed.data()), packed.size());
        if (result != Z_OK) failAt(image.packed, "the samples cannot be unpacked");
        samples.resize(size);
    }
    if (samples.size() != image.samples() && samples.size() != image.allSamples())
        failAt(image.packed, fmt::format("the image has {} samples; {} beams and {} ranges have {}", samples.size(),
                                         image.beams, image.end_range - image.start_range, image.samples()));
    return samples;
}

std::vector<double> GlfFile::readBearings(std::span<const char> record, const Image& image) const {
    std::vector<double> bearings;
    for (uint32_t beam = 0; beam < image.beams; ++beam) {
        const size_t at = image.bearings + beam * sizeof(double);
        bearings.push_back(field<double>(record, at));
        if (!(std::abs(bearings.back()) <= std::numbers::pi))
            failAt(at, fmt::format("the bearing of beam {} is {:g} rad; it must be -pi to pi", beam, bearings.back()));
    }
    return bearings;
}

void GlfFile::setRanges(std::span<const char> tail, const Image& image, RecordedPing& to) {
    const auto rate = field<uint32_t>(tail, glf::modulation);
    if (rate < 100 || rate > 1'000'000)
        failAt(image.tail + glf::modulation,
               fmt::format("the modulation frequency is {} Hz; it must be 100 to 1000000", rate));
    double speed = static_cast<double>(field<float>(tail, glf::sound_speed));
    if (speed == 0) speed = 1500;
    if (!(speed >= 1000 && speed <= 2000))
        failAt(image.tail + glf::sound_speed,
               fmt::format("the speed of sound is {:g} m/s; it may be 1000 to 2000, or 0 for unknown", speed));
    setResolution(speed / 2 / rate, speed, to);
}

std::optional<RecordedPing> GlfFile::getFrame(std::span<const char> record, const Image& image) {
    if (image.compression == glf::h264) return ++videos_, std::nullopt;
    const std::span<const char> tail = record.subspan(image.tail);
    const double transmitted = field<double>(tail, glf::transmit_time);
    const bool has_time = transmitted != 0;
    const double time_us = std::round(((has_time ? transmitted : stamp_) + glf::epoch_s) * 1e6);
    if (const std::string wrong = findDiagnostic(time_us); !wrong.empty())
        failAt(has_time ? image.tail + glf::transmit_time : glf::stamp, wrong);
    RecordedPing found;
    found.ping.time = {static_cast<int64_t>(time_us)};
    setRanges(tail, image, found);
    const std::vector<char> samples = getSamples(record, image);
    const bool has_all = samples.size() == image.allSamples();
    setFan(readBearings(record, image), has_all ? 0 : image.start_range, samples, found);
    found.window_start = found.ping.binStart(image.start_range);
    found.frequency_khz = geminiFrequency(field<uint8_t>(tail, glf::platform), field<uint16_t>(tail, glf::ping_flags));
    found.sonar.position.x = types::Pose::unknown;
    inverted_ += (field<uint32_t>(tail, glf::state) & glf::inverted) != 0;
    return found;
}

void GlfFile::skipToRecord(size_t size) {
    constexpr size_t block = 4096;
    constexpr double near_s = 7 * 24 * 3600;
    entry_.skip(size);
    for (std::span<const char> bytes = entry_.peek(block); bytes.size() >= glf::head; bytes = entry_.peek(block)) {
        for (size_t i = 0; i + glf::head <= bytes.size(); ++i)
            if (beginsRecord(bytes.subspan(i)) && std::abs(field<double>(bytes, i + glf::stamp) - stamp_) < near_s)
                return entry_.skip(i);
        entry_.skip(bytes.size() - glf::head + 1);
    }
    entry_.skip(glf::head);  // the rest is not a record
}

std::optional<RecordedPing> GlfFile::read() {
    for (;;) {
        std::span<const char> record = entry_.peek(glf::numbers + 2);
        if (endsHere(record)) return std::nullopt;
        if (!beginsRecord(record))
            failAt(0, fmt::format("is 0x{:02X}{:02X}; a record begins with 0x2A, a known type and a time",
                                  field<uint8_t>(record, 0), field<uint8_t>(record, 1)));
        stamp_ = field<double>(record, glf::stamp);
        if (const int type = field<uint8_t>(record, glf::type); type != glf::image_type) {
            ++other_types_[type];
            skipToRecord(glf::header);
            continue;
        }
        const bool has_numbers = record.size() == glf::numbers + 2;
        const Image image = has_numbers ? getImage(record) : Image{};
        record = entry_.peek(image.size);
        if (!has_numbers || record.size() < image.size) {
            cut_off_record_ = entry_.at();
            return std::nullopt;
        }
        const bool is_zoomed = field<uint8_t>(record, image.tail + glf::is_zoomed) != 0;
        const auto mark = field<uint16_t>(record, image.tail + glf::tail_mark);
        if (!is_zoomed && mark != glf::end_mark)
            failAt(image.tail + glf::tail_mark,
                   fmt::format("is 0x{:04X}; an image ends with 0x{:04X}", mark, glf::end_mark));
        const auto device = field<uint16_t>(record, glf::device);
        if (!device_) device_ = device;
        std::optional<RecordedPing> found;
        if (device == *device_)
            found = getFrame(record, image);
        else
            ++other_devices_[device];
        zooms_ += is_zoomed;
        is_zoomed ? skipToRecord(image.tail + glf::tail_mark) : entry_.skip(image.size);
        if (found) return found;
    }
}

std::vector<std::string> GlfFile::notices() const {
    std::vector<std::string> all = RecordingReader::notices();
    if (!entry_.diagnostic().empty()) all.push_back(fmt::format("{}: {}", entry_.name(), entry_.diagnostic()));
    if (cut_off_record_)
        all.push_back(fmt::format("the record at byte {} of {} is cut off", *cut_off_record_, entry_.name()));
    for (const auto& [type, count] : other_types_)
        all.push_back(fmt::format("{} records of type {} are omitted: only images (type 0) are read", count, type));
    for (const auto& [device, count] : other_devices_)
        all.push_back(fmt::format("{} images of sonar {} are omitted: only those of the first, {}, are read", count,
                                  device, *device_));
    if (zooms_ > 0) all.push_back(fmt::format("{} acoustic zooms next to their images are omitted", zooms_));
    if (videos_ > 0) all.push_back(fmt::format("{} images are packed as H.264 and are omitted", videos_));
    if (inverted_ > 0)
        all.push_back(
            fmt::format("{} images state that the sonar hung upside down; their bearings are the file's", inverted_));
    return all;
}

}  // namespace insonify::recordings
