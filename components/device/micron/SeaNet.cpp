#include "components/device/micron/SeaNet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "types/Check.hpp"

namespace insonify::device {
namespace {

constexpr uint8_t start = '@', end = 0x0A, sequence_end = 0x80;
constexpr size_t frame_size = 14;    // packet without a payload [bytes]
constexpr size_t outside = 6;        // bytes that the length does not count
constexpr size_t payload_at = 13;    // in a packet
constexpr size_t max_packet = 4096;  // as in drivers

/** Places in payloads [bytes]. */
namespace command_at {
constexpr size_t control = 1, head = 3, transmit = 4, range = 22, left = 24, right = 26, ad_span = 28, ad_low = 29,
                 gain = 30, motor_delay = 36, step = 37, ad_interval = 38, bins = 40, min_size = 42, size = 52;
}
namespace data_at {
constexpr size_t size = 0, head = 2, status = 3, sweep = 4, control = 5, range = 7, transmit = 9, gain = 13,
                 ad_span = 16, ad_low = 17, ad_interval = 20, left = 22, right = 24, step = 26, bearing = 27,
                 count = 29, data = 31;
}
namespace alive_at {
constexpr size_t time = 1, bearing = 5, state = 7, size = 8;
}
namespace version_at {
constexpr size_t software = 0, info = 1, serial = 2, length = 4, sum = 8, node = 10, size = 11;
}
namespace user_at {
constexpr size_t half_duplex = 133, size = 250, small_size = 161;
}
constexpr uint8_t plain_command = 1, reversal = 0x0F;

bool is(const SeaNetMessage& message, SeaNetType type, size_t size) {
    return message.type == type && message.payload.size() == size;
}

SeaNetMessage answer(SeaNetType type, size_t size) {
    return {type, seanet_imaging_sonar, seanet_computer, Bytes(size)};
}

/** Parses four hexadecimal digits; none for other characters. */
std::optional<size_t> hexadecimal(std::span<const uint8_t, 4> digits) {
    size_t value = 0;
    const auto* first = reinterpret_cast<const char*>(digits.data());
    const auto [last, error] = std::from_chars(first, first + digits.size(), value, 16);
    if (error != std::errc{} || last != first + digits.size()) return std::nullopt;
    return value;
}

}  // namespace

Bytes SeaNetMessage::packet() const {
    Bytes bytes(frame_size + payload.size());
    const size_t length = bytes.size() - outside;
    INSONIFY_CHECK(length <= UINT16_MAX, length);
    const bool counted = type != SeaNetType::HeadData && payload.size() + 3 <= UINT8_MAX;
    bytes[0] = start;
    std::ranges::copy(fmt::format("{:04X}", length), bytes.begin() + 1);
    write(bytes, 5, static_cast<uint16_t>(length));
    bytes[7] = from;
    bytes[8] = to;
    bytes[9] = static_cast<uint8_t>(counted ? payload.size() + 3 : 0);
    bytes[10] = static_cast<uint8_t>(type);
    bytes[11] = sequence_end;
    bytes[12] = from == seanet_computer ? to : from;
    std::ranges::copy(payload, bytes.begin() + payload_at);
    bytes.back() = end;
    return bytes;
}

SeaNetMessage SeaNetHeadCommand::message() const {
    SeaNetMessage made{SeaNetType::HeadCommand, seanet_computer, seanet_imaging_sonar, Bytes(command_at::size)};
    Bytes& payload = made.payload;
    payload[0] = plain_command;
    write(payload, command_at::control, control);
    payload[command_at::head] = head_type;
    for (size_t i = 0; i < 2; ++i) write(payload, command_at::transmit + 4 * i, transmit[i]);
    write(payload, command_at::range, range_decimetres);
    write(payload, command_at::left, left);
    write(payload, command_at::right, right);
    payload[command_at::ad_span] = ad_span;
    payload[command_at::ad_low] = ad_low;
    payload[command_at::gain] = payload[command_at::gain + 1] = gain;
    payload[command_at::motor_delay] = motor_delay;
    payload[command_at::step] = step;
    write(payload, command_at::ad_interval, ad_interval);
    write(payload, command_at::bins, bins);
    return made;
}

std::optional<SeaNetHeadCommand> SeaNetHeadCommand::in(const SeaNetMessage& message) {
    const Bytes& payload = message.payload;
    if (message.type != SeaNetType::HeadCommand || payload.size() < command_at::min_size) return std::nullopt;
    SeaNetHeadCommand command;
    command.control = read<uint16_t>(payload, command_at::control);
    command.head_type = payload[command_at::head];
    for (size_t i = 0; i < 2; ++i) command.transmit[i] = read<uint32_t>(payload, command_at::transmit + 4 * i);
    command.range_decimetres = read<uint16_t>(payload, command_at::range);
    command.left = read<uint16_t>(payload, command_at::left);
    command.right = read<uint16_t>(payload, command_at::right);
    command.ad_span = payload[command_at::ad_span];
    command.ad_low = payload[command_at::ad_low];
    command.gain = payload[command_at::gain + (command.has(SeaNetControl::second_channel) ? 1 : 0)];
    command.motor_delay = payload[command_at::motor_delay];
    command.step = payload[command_at::step];
    command.ad_interval = read<uint16_t>(payload, command_at::ad_interval);
    command.bins = read<uint16_t>(payload, command_at::bins);
    return command;
}

bool SeaNetHeadCommand::isReversal(const SeaNetMessage& message) {
    return message.type == SeaNetType::HeadCommand && message.payload == Bytes{reversal};
}

SeaNetMessage SeaNetHeadData::message() const {
    SeaNetMessage made = answer(SeaNetType::HeadData, data_at::data + data.size());
    Bytes& payload = made.payload;
    write(payload, data_at::size, static_cast<uint16_t>(payload.size()));
    payload[data_at::head] = command.head_type;
    payload[data_at::status] = status;
    payload[data_at::sweep] = sweep;
    write(payload, data_at::control, command.control);
    write(payload, data_at::range, command.range_decimetres);
    write(payload, data_at::transmit, command.transmit[command.has(SeaNetControl::second_channel) ? 1 : 0]);
    payload[data_at::gain] = command.gain;
    payload[data_at::ad_span] = command.ad_span;
    payload[data_at::ad_low] = command.ad_low;
    write(payload, data_at::ad_interval, command.ad_interval);
    write(payload, data_at::left, command.left);
    write(payload, data_at::right, command.right);
    payload[data_at::step] = command.step;
    write(payload, data_at::bearing, bearing);
    write(payload, data_at::count, static_cast<uint16_t>(data.size()));
    std::ranges::copy(data, payload.begin() + data_at::data);
    return made;
}

std::optional<SeaNetHeadData> SeaNetHeadData::in(const SeaNetMessage& message) {
    const Bytes& payload = message.payload;
    if (message.type != SeaNetType::HeadData || payload.size() < data_at::data) return std::nullopt;
    const size_t count = read<uint16_t>(payload, data_at::count);
    if (payload.size() != data_at::data + count || read<uint16_t>(payload, data_at::size) != payload.size())
        return std::nullopt;
    SeaNetHeadData line;
    line.command.head_type = payload[data_at::head];
    line.status = payload[data_at::status];
    line.sweep = payload[data_at::sweep];
    line.command.control = read<uint16_t>(payload, data_at::control);
    line.command.range_decimetres = read<uint16_t>(payload, data_at::range);
    line.command.transmit[line.command.has(SeaNetControl::second_channel) ? 1 : 0] =
        read<uint32_t>(payload, data_at::transmit);
    line.command.gain = payload[data_at::gain];
    line.command.ad_span = payload[data_at::ad_span];
    line.command.ad_low = payload[data_at::ad_low];
    line.command.ad_interval = read<uint16_t>(payload, data_at::ad_interval);
    line.command.left = read<uint16_t>(payload, data_at::left);
    line.command.right = read<uint16_t>(payload, data_at::right);
    line.command.step = payload[data_at::step];
    line.bearing = read<uint16_t>(payload, data_at::bearing);
    line.command.bins = static_cast<uint16_t>(line.command.has(SeaNetControl::eight_bits) ? count : 2 * count);
    line.data.assign(payload.begin() + data_at::data, payload.end());
    return line;
}

SeaNetMessage SeaNetAlive::message() const {
    SeaNetMessage made = answer(SeaNetType::Alive, alive_at::size);
    write(made.payload, alive_at::time, milliseconds);
    write(made.payload, alive_at::bearing, bearing);
    made.payload[alive_at::state] =
        static_cast<uint8_t>((recentring ? 1 : 0) | (centred ? 2 : 0) | (motor_on ? 8 : 0) | (scanning ? 32 : 0) |
                             (unconfigured ? 64 : 0) | (configured ? 128 : 0));
    return made;
}

std::optional<SeaNetAlive> SeaNetAlive::in(const SeaNetMessage& message) {
    if (!is(message, SeaNetType::Alive, alive_at::size)) return std::nullopt;
    const uint8_t state = message.payload[alive_at::state];
    SeaNetAlive alive;
    alive.recentring = (state & 1) != 0;
    alive.centred = (state & 2) != 0;
    alive.motor_on = (state & 8) != 0;
    alive.scanning = (state & 32) != 0;
    alive.unconfigured = (state & 64) != 0;
    alive.configured = (state & 128) != 0;
    alive.milliseconds = read<uint32_t>(message.payload, alive_at::time);
    alive.bearing = read<uint16_t>(message.payload, alive_at::bearing);
    return alive;
}

SeaNetMessage SeaNetVersion::message() const {
    SeaNetMessage made = answer(SeaNetType::VersionData, version_at::size);
    made.payload[version_at::software] = software;
    made.payload[version_at::info] = info;
    write(made.payload, version_at::serial, serial);
    write(made.payload, version_at::length, program_length);
    write(made.payload, version_at::sum, program_sum);
    made.payload[version_at::node] = seanet_imaging_sonar;
    return made;
}

std::optional<SeaNetVersion> SeaNetVersion::in(const SeaNetMessage& message) {
    if (!is(message, SeaNetType::VersionData, version_at::size)) return std::nullopt;
    const Bytes& payload = message.payload;
    return SeaNetVersion{payload[version_at::software], payload[version_at::info],
                         read<uint16_t>(payload, version_at::serial), read<uint32_t>(payload, version_at::length),
                         read<uint16_t>(payload, version_at::sum)};
}

SeaNetMessage SeaNetUserData::message() const {
    SeaNetMessage made = answer(SeaNetType::UserData, user_at::size);
    made.payload[user_at::half_duplex] = full_duplex ? 0 : 1;
    return made;
}

std::optional<SeaNetUserData> SeaNetUserData::in(const SeaNetMessage& message) {
    if (!is(message, SeaNetType::UserData, user_at::size) && !is(message, SeaNetType::UserData, user_at::small_size))
        return std::nullopt;
    return SeaNetUserData{message.payload[user_at::half_duplex] == 0};
}

SeaNetMessage seaNetRequest(SeaNetType type) {
    return {type, seanet_computer, seanet_imaging_sonar, Bytes(type == SeaNetType::SendData ? 4 : 0)};
}

size_t SeaNetReader::getSize(std::span<const uint8_t> bytes) const {
    constexpr size_t with_lengths = 7;
    if (bytes[0] != start) return 0;
    if (bytes.size() < with_lengths) return with_lengths;
    const size_t length = read<uint16_t>(bytes, 5), size = length + outside;
    if (hexadecimal(bytes.subspan(1).first<4>()) != length || size < frame_size || size > max_packet) return 0;
    return size > bytes.size() || bytes[size - 1] == end ? size : 0;
}

std::optional<SeaNetMessage> SeaNetReader::next() {
    const auto packet = nextFrame();
    if (packet.empty()) return std::nullopt;
    const auto payload = packet.subspan(payload_at, packet.size() - payload_at - 1);
    return SeaNetMessage{static_cast<SeaNetType>(packet[10]), packet[7], packet[8],
                         Bytes(payload.begin(), payload.end())};
}

}  // namespace insonify::device
