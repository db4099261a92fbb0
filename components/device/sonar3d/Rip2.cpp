#include "components/device/sonar3d/Rip2.hpp"

#include <fmt/format.h>
#include <snappy.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "components/device/sonar3d/Protobuf.hpp"

namespace insonify::device {
namespace {

constexpr size_t packet_header_size = 8, crc_size = 4, max_diagnostics = 100;
constexpr size_t max_image_bytes = size_t{1} << 22;  // uncompressed [bytes]
constexpr std::string_view magic1 = "RIP1", magic2 = "RIP2", type_url = "type.googleapis.com/",
                           package = "waterlinked.sonar.protocol.", range_image = "RangeImage",
                           strength_image = "BitmapImageGreyscale8";

/** Numbers of a message's fields; both kinds have the same fields in different places. */
struct Fields {
    uint32_t type, width, height, field_of_view, vertical_opening, scale, pixels;
};
constexpr Fields range_fields{0, 5, 6, 7, 8, 9, 10}, strength_fields{5, 6, 7, 8, 9, 0, 10};
constexpr uint32_t header_field = 1, speed_field = 2, range_field = 3, frequency_field = 4;

uint32_t crc(std::span<const uint8_t> bytes) {
    return static_cast<uint32_t>(crc32(0, bytes.data(), static_cast<uInt>(bytes.size())));
}

Bytes makeHeader(const RipImage& image) {
    const int64_t seconds = image.time.microseconds / 1'000'000;
    ProtobufWriter stamp, header;
    stamp.number(1, static_cast<uint64_t>(seconds));
    stamp.number(2, static_cast<uint64_t>((image.time.microseconds - seconds * 1'000'000) * 1000));
    header.bytes(1, stamp.message());
    header.number(2, image.sequence);
    return header.message();
}

ProtobufWriter beginImage(const RipImage& image, const Fields& fields, uint32_t type) {
    ProtobufWriter message;
    message.bytes(header_field, makeHeader(image));
    message.real(speed_field, image.speed_of_sound);
    message.real(range_field, image.range);
    message.number(frequency_field, image.frequency_hz);
    if (fields.type > 0) message.number(fields.type, type);
    message.number(fields.width, image.width);
    message.number(fields.height, image.height);
    message.real(fields.field_of_view, image.field_of_view_deg);
    message.real(fields.vertical_opening, image.vertical_opening_deg);
    return message;
}

Bytes packet(std::string_view name, const Bytes& message, RipVersion version) {
    ProtobufWriter any, whole;
    any.text(1, fmt::format("{}{}{}", type_url, package, name));
    any.bytes(2, message);
    whole.bytes(1, any.message());
    std::string payload(whole.message().begin(), whole.message().end()), compressed;
    if (version == RipVersion::Rip2) {
        snappy::Compress(payload.data(), payload.size(), &compressed);
        payload.swap(compressed);
    }
    const std::string_view magic = version == RipVersion::Rip2 ? magic2 : magic1;
    Bytes bytes(magic.begin(), magic.end());
    append(bytes, static_cast<uint32_t>(packet_header_size + payload.size() + crc_size));
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    append(bytes, crc(bytes));
    return bytes;
}

/** A message that contradicts itself; its text continues "the packet at byte 7 ". */
struct BadPacket : std::runtime_error {
    using std::runtime_error::runtime_error;
};

types::Time stampIn(std::span<const uint8_t> bytes) {
    ProtobufReader reader(bytes);
    uint64_t seconds = 0, nanoseconds = 0;
    while (const auto field = reader.next()) {
        if (field->number == 1) seconds = field->value;
        if (field->number == 2) nanoseconds = field->value;
    }
    if (reader.isBroken() || seconds > (uint64_t{1} << 40) || nanoseconds >= 1'000'000'000)
        throw BadPacket("has a stamp that is none");
    return {static_cast<int64_t>(seconds * 1'000'000 + nanoseconds / 1000)};
}

void readHeader(std::span<const uint8_t> bytes, RipImage& image) {
    ProtobufReader reader(bytes);
    while (const auto field = reader.next()) {
        if (field->number == 1) image.time = stampIn(field->bytes);
        if (field->number == 2) image.sequence = static_cast<uint32_t>(field->value);
    }
    if (reader.isBroken()) throw BadPacket("has a header that is cut off");
}

void readShared(const ProtobufField& field, const Fields& fields, RipImage& image) {
    const auto number = static_cast<uint32_t>(std::min<uint64_t>(field.value, UINT32_MAX));
    if (field.number == header_field) readHeader(field.bytes, image);
    if (field.number == speed_field) image.speed_of_sound = field.real();
    if (field.number == range_field) image.range = field.real();
    if (field.number == frequency_field) image.frequency_hz = number;
    if (field.number == fields.width) image.width = number;
    if (field.number == fields.height) image.height = number;
    if (field.number == fields.field_of_view) image.field_of_view_deg = field.real();
    if (field.number == fields.vertical_opening) image.vertical_opening_deg = field.real();
}

void readPixels(const ProtobufField& field, std::vector<uint32_t>& pixels) {
    const auto add = [&](uint64_t value) {
        if (value > UINT16_MAX) throw BadPacket(fmt::format("has a pixel of {}; they have 16 bits", value));
        pixels.push_back(static_cast<uint32_t>(value));
    };
    if (field.kind != ProtobufField::Kind::Text) return add(field.value);  // one at a time works as well
    ProtobufReader reader(field.bytes);
    while (const auto value = reader.varint()) add(*value);
    if (reader.isBroken()) throw BadPacket("has pixels that are cut off");
}

void check(const RipImage& image, size_t pixels) {
    if (uint64_t{image.width} * image.height != pixels)
        throw BadPacket(fmt::format("has {} pixels, but its header has {} x {}", pixels, image.width, image.height));
    for (const float value : {image.speed_of_sound, image.range, image.field_of_view_deg, image.vertical_opening_deg})
        if (!std::isfinite(value) || value < 0) throw BadPacket(fmt::format("has a value of {:g}", value));
}

RangePixels rangeImageIn(std::span<const uint8_t> bytes) {
    RangePixels image;
    ProtobufReader reader(bytes);
    while (const auto field = reader.next()) {
        readShared(*field, range_fields, image);
        if (field->number == range_fields.scale) image.pixel_scale = field->real();
        if (field->number == range_fields.pixels) readPixels(*field, image.pixels);
    }
    if (reader.isBroken()) throw BadPacket("holds a range image that is cut off");
    check(image, image.pixels.size());
    if (!std::isfinite(image.pixel_scale) || image.pixel_scale < 0)
        throw BadPacket(fmt::format("has a pixel scale of {:g}", image.pixel_scale));
    return image;
}

StrengthPixels strengthImageIn(std::span<const uint8_t> bytes) {
    StrengthPixels image;
    ProtobufReader reader(bytes);
    while (const auto field = reader.next()) {
        readShared(*field, strength_fields, image);
        if (field->number == strength_fields.type)
            image.type = static_cast<uint32_t>(std::min<uint64_t>(field->value, UINT32_MAX));
        if (field->number == strength_fields.pixels) image.pixels.assign(field->bytes.begin(), field->bytes.end());
    }
    if (reader.isBroken()) throw BadPacket("holds a bitmap that is cut off");
    check(image, image.pixels.size());
    return image;
}

RipMessage messageIn(std::span<const uint8_t> any) {
    std::string type;
    std::span<const uint8_t> value;
    ProtobufReader reader(any);
    while (const auto field = reader.next()) {
        if (field->number == 1) type = field->text();
        if (field->number == 2) value = field->bytes;
    }
    if (reader.isBroken() || type.empty()) throw BadPacket("holds no message");
    const std::string name = type.substr(type.rfind('/') + 1);  // npos + 1 is the beginning
    if (name == fmt::format("{}{}", package, range_image)) return rangeImageIn(value);
    if (name == fmt::format("{}{}", package, strength_image)) return strengthImageIn(value);
    return OtherRipMessage{name};
}

/** Returns the uncompressed contents of a packet. */
std::string readPayload(std::span<const uint8_t> packet) {
    const auto* begin = reinterpret_cast<const char*>(packet.data()) + packet_header_size;
    const size_t size = packet.size() - packet_header_size - crc_size;
    if (packet[3] == '1') return {begin, size};
    size_t length = 0;
    std::string payload;
    if (!snappy::GetUncompressedLength(begin, size, &length) || length > max_image_bytes ||
        !snappy::Uncompress(begin, size, &payload))
        throw BadPacket("is compressed by something else than snappy");
    return payload;
}

RipMessage readPacket(std::span<const uint8_t> rest, size_t length) {
    if (length > rest.size()) throw BadPacket(fmt::format("is cut off after {} of {} bytes", rest.size(), length));
    const auto packet = rest.first(length);
    if (read<uint32_t>(packet, length - crc_size) != crc(packet.first(length - crc_size)))
        throw BadPacket("has a wrong checksum");
    const std::string payload = readPayload(packet);
    ProtobufReader reader({reinterpret_cast<const uint8_t*>(payload.data()), payload.size()});
    while (const auto field = reader.next())
        if (field->number == 1) return messageIn(field->bytes);
    throw BadPacket("holds no message");
}

bool beginsPacket(std::span<const uint8_t> bytes) {
    return bytes.size() >= magic1.size() &&
           (std::memcmp(bytes.data(), magic1.data(), 4) == 0 || std::memcmp(bytes.data(), magic2.data(), 4) == 0);
}

/** Returns the length of the packet at the beginning of the bytes. */
size_t computeLength(std::span<const uint8_t> bytes) {
    if (bytes.size() < packet_header_size) throw BadPacket(fmt::format("is cut off after {} bytes", bytes.size()));
    const size_t length = read<uint32_t>(bytes, 4);
    if (length < packet_header_size + crc_size || length > max_rip_packet)
        throw BadPacket(fmt::format("has a length of {} bytes; may have {} to {}", length,
                                    packet_header_size + crc_size, max_rip_packet));
    return length;
}

}  // namespace

Bytes ripPacket(const RangePixels& image, RipVersion version) {
    ProtobufWriter message = beginImage(image, range_fields, 0);
    message.real(range_fields.scale, image.pixel_scale);
    message.packed(range_fields.pixels, image.pixels);
    return packet(range_image, message.message(), version);
}

Bytes ripPacket(const StrengthPixels& image, RipVersion version) {
    ProtobufWriter message = beginImage(image, strength_fields, image.type);
    message.bytes(strength_fields.pixels, image.pixels);
    return packet(strength_image, message.message(), version);
}

std::vector<RipMessage> ripMessages(std::span<const uint8_t> bytes, std::vector<std::string>* diagnostics) {
    std::vector<RipMessage> messages;
    for (size_t at = 0; at < bytes.size();) {
        const auto rest = bytes.subspan(at);
        if (!beginsPacket(rest)) {
            ++at;
            continue;
        }
        try {
            const size_t length = computeLength(rest);
            messages.push_back(readPacket(rest, length));
            at += length;
        } catch (const BadPacket& error) {
            if (diagnostics && diagnostics->size() < max_diagnostics)
                diagnostics->push_back(fmt::format("the packet at byte {} {}", at, error.what()));
            at += magic1.size();
        }
    }
    return messages;
}

}  // namespace insonify::device
