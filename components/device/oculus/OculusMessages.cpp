#include "components/device/oculus/OculusMessages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "types/Check.hpp"

namespace insonify::device {
namespace {

void visitHeader(auto& header, auto& visit) {
    uint16_t mark = oculus_mark;
    visit(mark, header.source, header.destination, header.id, header.version, header.payload_size, header.part);
}

void visitFire(auto& fire, auto& visit) {
    visitHeader(fire.header, visit);
    visit(fire.mode, fire.rate, fire.network_speed, fire.gamma, fire.flags, fire.range, fire.gain_percent,
          fire.speed_of_sound, fire.salinity);
    if (!fire.isVersion2()) return;
    visit(fire.extended_flags, fire.reserved);
}

void visitResult(auto& result, auto& visit) {
    visitFire(result.fire, visit);
    const bool version2 = result.fire.isVersion2();
    visit(result.number, result.status, result.frequency_hz, result.temperature_celsius, result.pressure_bar);
    if (version2) visit(result.heading_deg, result.pitch_deg, result.roll_deg);
    visit(result.speed_of_sound);
    version2 ? visit(result.start_s) : visit(result.start_ticks);
    visit(result.code_size, result.range_resolution, result.bin_count, result.beam_count);
    if (version2) visit(result.spare);
    visit(result.image_offset, result.image_size, result.message_size);
}

void visitStatus(auto& status, auto& visit) {
    visitHeader(status.header, visit);
    visit(status.device_id, status.device_type, status.part, status.status, status.versions, status.address,
          status.mask, status.connected, status.mac, status.temperatures, status.pressure_bar);
}

void visitUserConfig(auto& config, auto& visit) {
    visitHeader(config.header, visit);
    visit(config.address, config.mask, config.dhcp);
}

/** Returns why a ping with a complete fixed part is invalid; empty: it is valid. */
std::string numbersDiagnostic(const OculusResult& ping, size_t size) {
    if (ping.codeBytes() > 4) return fmt::format("has codes of {} bytes; there are 1 to 4", ping.codeBytes());
    if (ping.beam_count == 0 || ping.bin_count == 0)
        return fmt::format("has {} beams of {} bins", ping.beam_count, ping.bin_count);
    const size_t made = ping.bin_count * ping.rowBytes(), image = ping.image_offset;
    if (ping.image_size != made)
        return fmt::format("has an image of {} bytes where bins and beams make {}", ping.image_size, made);
    if (image < ping.fixedSize() + 2 * size_t{ping.beam_count} || image + made > size)
        return fmt::format("has an image of {} bytes at {} in a message of {}", made, image, size);
    if (!(ping.range_resolution > 0 && ping.range_resolution < 1e3))
        return fmt::format("has bins of {:g} m", ping.range_resolution);
    if (!(ping.frequency_hz >= 0 && ping.frequency_hz < 1e9))
        return fmt::format("has a frequency of {:g} Hz", ping.frequency_hz);
    if (!(ping.speed_of_sound >= 0 && ping.speed_of_sound < 1e4))
        return fmt::format("has a speed of sound of {:g} m/s", ping.speed_of_sound);
    return "";
}

std::string resultDiagnostic(std::span<const uint8_t> message, OculusResult& ping) {
    const auto header = oculusHeader(message);
    if (!header || !header->is(OculusId::PingResult)) return "does not begin as one";
    const size_t fixed = header->version == 2 ? OculusResult::size_v2 : OculusResult::size_v1;
    if (message.size() < fixed) return fmt::format("is cut off after {} bytes", message.size());
    ping.fire.header = *header;
    NumberReader take(message);
    visitResult(ping, take);
    return numbersDiagnostic(ping, message.size());
}

/** Returns the size of the whole message of this header; 0: no message has this header. */
size_t messageSize(const OculusHeader& header) {
    constexpr size_t max_other_payload = 4096;
    const size_t payload = header.payload_size;
    const auto whole = [&](bool possible) { return possible ? OculusHeader::size + payload : 0; };
    switch (static_cast<OculusId>(header.id)) {
        case OculusId::Fire:
            if (payload == 0) return header.version == 2 ? OculusFire::size_v2 : OculusFire::size_v1;
            return whole(payload + OculusHeader::size >= OculusFire::size_v1 && payload <= 256);
        case OculusId::UserConfig:
            return whole(payload + OculusHeader::size >= OculusUserConfig::size && payload <= 64);
        case OculusId::PingResult: return whole(payload + OculusHeader::size > OculusResult::size_v1);
        case OculusId::FullResult: return whole(true);
        case OculusId::Status:
        case OculusId::Log:
        case OculusId::Dummy: return whole(payload <= max_other_payload);
        default: return 0;
    }
}

Bytes headerBytes(OculusHeader header) {
    NumberWriter writer;
    visitHeader(header, writer);
    return std::move(writer.bytes);
}

}  // namespace

size_t OculusFire::codeBytes() const {
    if (isVersion2() && (extended_flags & wide_32) != 0) return 4;
    return (flags & wide_16) != 0 ? 2 : 1;
}

double OculusFire::rateHz() const {
    constexpr double rates[] = {10, 15, 40, 5, 2, 0};
    return rate < std::size(rates) ? rates[rate] : rates[0];
}

void OculusResult::settle() {
    INSONIFY_CHECK(bearings.size() == beam_count, bearings.size(), beam_count);
    image_offset = static_cast<uint32_t>(fixedSize() + 2 * bearings.size() + before_image.size());
    image_size = static_cast<uint32_t>(image.size());
    message_size = static_cast<uint32_t>(image_offset + image.size() + after_image.size());
    fire.header.payload_size = static_cast<uint32_t>(message_size - OculusHeader::size);
}

std::optional<OculusHeader> oculusHeader(std::span<const uint8_t> bytes) {
    if (bytes.size() < OculusHeader::size || read<uint16_t>(bytes, 0) != oculus_mark) return std::nullopt;
    OculusHeader header;
    NumberReader take(bytes);
    visitHeader(header, take);
    return header;
}

std::optional<OculusFire> oculusFire(std::span<const uint8_t> message) {
    const auto header = oculusHeader(message);
    if (!header || !header->is(OculusId::Fire) || message.size() < OculusFire::size_v1) return std::nullopt;
    Bytes whole(message.begin(), message.end());
    whole.resize(std::max(whole.size(), OculusFire::size_v2));  // fields missing in version 2 are 0
    OculusFire fire{.header = *header};
    NumberReader take(whole);
    visitFire(fire, take);
    return fire;
}

Bytes toBytes(OculusFire fire) {
    fire.header.payload_size = static_cast<uint32_t>(fire.size() - OculusHeader::size);
    NumberWriter writer;
    visitFire(fire, writer);
    return std::move(writer.bytes);
}

std::optional<OculusResult> oculusResult(std::span<const uint8_t> message, std::string* diagnostic) {
    OculusResult ping;
    const std::string reason = resultDiagnostic(message, ping);
    if (diagnostic) *diagnostic = reason;
    if (!reason.empty()) return std::nullopt;
    const size_t bearings_end = ping.fixedSize() + 2 * size_t{ping.beam_count};
    for (size_t at = ping.fixedSize(); at < bearings_end; at += 2) ping.bearings.push_back(read<int16_t>(message, at));
    const auto part = [&](size_t from, size_t to) { return Bytes(message.begin() + from, message.begin() + to); };
    const size_t image_end = size_t{ping.image_offset} + ping.image_size;
    ping.before_image = part(bearings_end, ping.image_offset);
    ping.image = part(ping.image_offset, image_end);
    ping.after_image = part(image_end, message.size());
    return ping;
}

Bytes toBytes(const OculusResult& result) {
    NumberWriter writer;
    visitResult(result, writer);
    writer.bytes.reserve(writer.bytes.size() + 2 * result.bearings.size() + result.before_image.size() +
                         result.image.size() + result.after_image.size());
    INSONIFY_CHECK(writer.bytes.size() == result.fixedSize(), writer.bytes.size(), result.fixedSize());
    for (const int16_t bearing : result.bearings) writer(bearing);
    for (const Bytes* part : {&result.before_image, &result.image, &result.after_image})
        writer.bytes.insert(writer.bytes.end(), part->begin(), part->end());
    return std::move(writer.bytes);
}

std::optional<OculusStatus> oculusStatus(std::span<const uint8_t> datagram) {
    if (datagram.size() != OculusStatus::size || !oculusHeader(datagram)) return std::nullopt;
    OculusStatus status;
    NumberReader take(datagram);
    visitStatus(status, take);
    return status;
}

Bytes toBytes(const OculusStatus& status) {
    NumberWriter writer;
    visitStatus(status, writer);
    return std::move(writer.bytes);
}

std::optional<OculusUserConfig> oculusUserConfig(std::span<const uint8_t> message) {
    const auto header = oculusHeader(message);
    if (!header || !header->is(OculusId::UserConfig) || message.size() < OculusUserConfig::size) return std::nullopt;
    OculusUserConfig config;
    NumberReader take(message);
    visitUserConfig(config, take);
    return config;
}

Bytes toBytes(const OculusUserConfig& config) {
    NumberWriter writer;
    visitUserConfig(config, writer);
    return std::move(writer.bytes);
}

Bytes oculusDummy(uint16_t source, uint16_t part) {
    return headerBytes({.source = source, .id = static_cast<uint16_t>(OculusId::Dummy), .part = part});
}

Bytes oculusLog(uint16_t source, uint16_t part, const std::string& text) {
    Bytes bytes = headerBytes({.source = source,
                               .id = static_cast<uint16_t>(OculusId::Log),
                               .payload_size = static_cast<uint32_t>(text.size()),
                               .part = part});
    bytes.insert(bytes.end(), text.begin(), text.end());
    return bytes;
}

size_t OculusFramer::getSize(std::span<const uint8_t> bytes) const {
    if (bytes.size() < OculusHeader::size) return OculusHeader::size;
    const auto header = oculusHeader(bytes);
    return header && header->payload_size <= maximum_ ? messageSize(*header) : 0;
}

Bytes OculusFramer::next() {
    const auto message = nextFrame();
    return {message.begin(), message.end()};
}

bool OculusFramer::giveUp() {
    if (waiting() < OculusHeader::size) return false;
    skip(1);
    return true;
}

}  // namespace insonify::device
