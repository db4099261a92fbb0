#include "components/device/OculusRecording.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <stdexcept>

#include "components/device/OculusPing.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::device {
namespace {

constexpr uint32_t file_mark = 0x11223344, item_mark = 0xaabbccdd;
constexpr size_t max_recorded_payload = size_t{1} << 28;

void visitFileHeader(auto& header, auto&& visit) {
    visit(header.source, header.version, header.encryption, header.unused, header.key, header.time);
}

void visitItem(auto& item, auto&& payload_size, auto&& visit) {
    visit(item.type, item.version, item.unused_a, item.time, item.compression, item.unused_b, item.original_size,
          payload_size, item.unused_c);
}

constexpr size_t mark_size = 8;  ///< Size of the mark and the size.

Bytes marked(uint32_t mark, size_t size) {
    NumberWriter writer;
    writer(mark, static_cast<uint32_t>(size));
    return std::move(writer.bytes);
}

bool isMarked(const Bytes& bytes, uint32_t mark, size_t size) {
    return bytes.size() == size && read<uint32_t>(bytes, 0) == mark && read<uint32_t>(bytes, 4) == size;
}

Bytes firstBytes(const std::filesystem::path& file, size_t size) {
    std::ifstream stream(file, std::ios::binary);
    Bytes bytes(size);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    bytes.resize(static_cast<size_t>(stream.gcount()));
    return bytes;
}

void refuseUnreadable(const std::filesystem::path& file) {
    if (!std::ifstream(file, std::ios::binary) || std::filesystem::is_directory(file))
        throw types::ConfigError(file.string(), "", "cannot be read; it must be a recording of an Oculus");
}

}  // namespace

std::optional<Bytes> OculusItem::content() const {
    if (compression != zipped) return payload;
    constexpr size_t size_bytes = 4;
    if (payload.size() < size_bytes || original_size > max_recorded_payload) return std::nullopt;
    Bytes unpacked(std::max<size_t>(original_size, 1));
    uLongf size = original_size;
    const int result = uncompress(unpacked.data(), &size, payload.data() + size_bytes, payload.size() - size_bytes);
    if (result != Z_OK || size != original_size) return std::nullopt;
    unpacked.resize(size);
    return unpacked;
}

bool OculusRecording::isOne(const std::filesystem::path& file) {
    return isMarked(firstBytes(file, OculusFileHeader::size), file_mark, OculusFileHeader::size);
}

OculusRecording::OculusRecording(const std::filesystem::path& file) {
    refuseUnreadable(file);
    file_.open(file, std::ios::binary);
    size_ = std::filesystem::file_size(file);
    const Bytes bytes = take(OculusFileHeader::size);
    if (!isMarked(bytes, file_mark, OculusFileHeader::size))
        throw types::ConfigError(file.string(), "", "does not begin as a recording of the maker's viewer does");
    visitFileHeader(header_, NumberReader(bytes, mark_size));
    at_ = OculusFileHeader::size;
}

Bytes OculusRecording::take(size_t size) {
    Bytes bytes(static_cast<size_t>(std::min<uint64_t>(size, size_ - at_)));
    file_.seekg(static_cast<std::streamoff>(at_));
    file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!file_) throw std::runtime_error("the recording could no longer be read");
    return bytes;
}

void OculusRecording::passOver() {
    if (diagnostic_.empty()) diagnostic_ = fmt::format("no item begins at byte {}", at_);
    constexpr size_t block = 1 << 16;
    const Bytes mark = marked(item_mark, OculusItem::header_size);
    for (++at_; at_ < size_;) {
        const Bytes bytes = take(block);
        const auto found = std::search(bytes.begin(), bytes.end(), mark.begin(), mark.end());
        if (found != bytes.end()) {
            at_ += static_cast<uint64_t>(found - bytes.begin());
            return;
        }
        at_ += bytes.size() < block ? bytes.size() : bytes.size() - mark.size() + 1;
    }
}

std::optional<OculusItem> OculusRecording::next() {
    for (; at_ < size_; passOver()) {
        const Bytes bytes = take(OculusItem::header_size);
        if (!isMarked(bytes, item_mark, OculusItem::header_size)) continue;
        OculusItem item;
        uint32_t payload_size = 0;
        visitItem(item, payload_size, NumberReader(bytes, mark_size));
        if (payload_size > max_recorded_payload || at_ + OculusItem::header_size + payload_size > size_) continue;
        at_ += OculusItem::header_size;
        item.payload = take(payload_size);
        at_ += payload_size;
        return item;
    }
    return std::nullopt;
}

Bytes toBytes(const OculusFileHeader& header) {
    NumberWriter writer{marked(file_mark, OculusFileHeader::size)};
    visitFileHeader(header, writer);
    return std::move(writer.bytes);
}

Bytes toBytes(const OculusItem& item) {
    NumberWriter writer{marked(item_mark, OculusItem::header_size)};
    visitItem(item, static_cast<uint32_t>(item.payload.size()), writer);
    writer.bytes.insert(writer.bytes.end(), item.payload.begin(), item.payload.end());
    return std::move(writer.bytes);
}

OculusItem getItem(double time, std::span<const uint8_t> message) {
    return {.time = time,
            .original_size = static_cast<uint32_t>(message.size()),
            .payload = {message.begin(), message.end()}};
}

OculusRecorder::OculusRecorder(const std::filesystem::path& file, const OculusFileHeader& header)
    : path_(file), file_(file, std::ios::binary) {
    if (!file_) throw types::ConfigError(file.string(), "", "cannot be written");
    put(toBytes(header));
}

void OculusRecorder::put(const Bytes& bytes) {
    file_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    file_.flush();
    if (!file_) throw std::runtime_error(path_.string() + ": the recording can no longer be written");
}

/** The messages of either kind of file, with the file's times if it has any. */
struct OculusPings::Source {
    struct Message {
        Bytes bytes;  ///< Empty at the end.
        std::optional<double> time;
    };

    explicit Source(const std::filesystem::path& file) {
        refuseUnreadable(file);
        if (OculusRecording::isOne(file))
            recording.emplace(file);
        else
            capture.open(file, std::ios::binary);
    }

    Message next() { return recording ? nextOfRecording() : Message{nextOfCapture(), std::nullopt}; }

    /** Skips damaged items and those of other types. */
    Message nextOfRecording() {
        while (auto item = recording->next()) {
            if (item->type != OculusItem::sonar) continue;
            if (auto content = item->content(); content && !content->empty()) return {std::move(*content), item->time};
        }
        return {};
    }
    Bytes nextOfCapture() {
        Bytes block(1 << 16);
        for (;;) {
            if (Bytes message = framer.next(); !message.empty()) return message;
            capture.read(reinterpret_cast<char*>(block.data()), static_cast<std::streamsize>(block.size()));
            if (capture.gcount() == 0) {
                const uint64_t at = framer.position();
                if (!framer.giveUp()) return {};
                if (damage.empty()) damage = fmt::format("the message at byte {} is longer than the file", at);
                continue;
            }
            framer.add(std::span(block).first(static_cast<size_t>(capture.gcount())));
        }
    }

    /** Returns the time of a ping since the first one, by the device's clock [s]. */
    double clock(const OculusResult& ping) {
        const auto ticks = static_cast<uint32_t>(ping.start_ticks - start_ticks);  // wraps like the clock
        const double step = ping.fire.isVersion2() ? ping.start_s - start_s : ticks / oculus_ticks_per_second;
        if (known && step >= 0 && step < 1e6) elapsed += step;
        known = true;
        start_s = ping.start_s;
        start_ticks = ping.start_ticks;
        return elapsed;
    }

    std::optional<OculusRecording> recording;
    std::ifstream capture;
    OculusFramer framer;
    std::string damage;  ///< First skipped part of a capture; empty: none.
    bool known = false;
    double elapsed = 0, start_s = 0;
    uint32_t start_ticks = 0;
};

OculusPings::OculusPings(const std::filesystem::path& file) : source_(std::make_unique<Source>(file)) {}
OculusPings::~OculusPings() = default;

std::optional<TimedOculusResult> OculusPings::next() {
    for (auto message = source_->next(); !message.bytes.empty(); message = source_->next()) {
        const auto header = oculusHeader(message.bytes);
        if (!header || !header->is(OculusId::PingResult)) continue;
        std::string reason;
        ++number_;
        if (auto ping = oculusResult(message.bytes, &reason))
            return TimedOculusResult{message.time ? *message.time : source_->clock(*ping), std::move(*ping)};
        if (diagnostic_.empty()) diagnostic_ = fmt::format("ping {} {}", number_, reason);
    }
    if (diagnostic_.empty()) diagnostic_ = source_->recording ? source_->recording->diagnostic() : source_->damage;
    return std::nullopt;
}

std::vector<std::string> OculusReader::notices() const {
    std::vector<std::string> all = RecordingReader::notices();
    if (!pings_.diagnostic().empty()) all.push_back(pings_.diagnostic());
    return all;
}

std::optional<recordings::RecordedPing> OculusReader::read() {
    const auto recorded = pings_.next();
    if (!recorded) return std::nullopt;
    if (!begin_) begin_ = recorded->time;
    constexpr double start_of_captures = 1;  // 0 is not a valid time
    const OculusPing ping = makePing(recorded->ping);
    recordings::RecordedPing read;
    read.since_first = recorded->time - *begin_;
    read.ping =
        getSonar(ping, types::Time::fromSeconds((*begin_ > 0 ? *begin_ : start_of_captures) + read.since_first));
    read.sonar.position.x = types::Pose::unknown;
    read.number = ping.number;
    read.frequency_khz = ping.frequency_hz / 1e3;
    read.speed_of_sound = ping.speed_of_sound;
    read.range = ping.range_resolution * ping.bin_count;
    read.max_code = ping.maxCode();
    read.code = {.bits = ping.bits > 8 ? 16 : 8, .law = receiver::CodeLaw::Sqrt, .gamma = ping.gamma};
    read.law_known = true;
    return read;
}

}  // namespace insonify::device
