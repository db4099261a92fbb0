#include "components/device/OculusPing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>

#include "types/Angle.hpp"
#include "types/ConfigError.hpp"

namespace insonify::device {
namespace {

constexpr size_t header_size = 16, max_diagnostics = 100;
constexpr uint16_t oculus_id = 0x4F53, ping_result = 0x23;
constexpr size_t max_bins = 1 << 16;

/** Where a ping result has its fields, from the beginning of the message [bytes]. */
struct Layout {
    size_t number, frequency, speed_of_sound, code_size, resolution, bins, beams, image, image_size, bearings;
};
constexpr Layout version1{53, 61, 85, 97, 98, 106, 108, 110, 114, 122};
constexpr Layout version2{89, 97, 145, 161, 162, 170, 172, 190, 194, 202};
constexpr size_t gamma_at = 19, flags_at = 20;
constexpr uint8_t with_row_gains = 0x04;

/** Little endian, as processors that this runs on. */
template <class T>
T read(std::span<const uint8_t> bytes, size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/** One message, whose header has been seen. */
class Message {
public:
    explicit Message(std::span<const uint8_t> bytes)
        : bytes_(bytes), layout_(read<uint16_t>(bytes, 8) == 2 ? version2 : version1) {}

    /** Why this is no ping; empty: it is one. */
    std::string diagnostic() const {
        if (bytes_.size() < layout_.bearings) return fmt::format("is cut off after {} bytes", bytes_.size());
        if (codeBytes() > 4) return fmt::format("has codes of {} bytes; there are 1 to 4", codeBytes());
        if (beams() == 0 || bins() == 0 || bins() > max_bins)
            return fmt::format("has {} beams of {} bins", beams(), bins());
        const size_t made = bins() * rowBytes(), image = read<uint32_t>(bytes_, layout_.image),
                     size = read<uint32_t>(bytes_, layout_.image_size);
        if (size != made) return fmt::format("has an image of {} bytes where bins and beams make {}", size, made);
        if (image < layout_.bearings + 2 * beams() || image + size > bytes_.size())
            return fmt::format("has an image of {} bytes at {} in a message of {}", size, image, bytes_.size());
        const double resolution = read<double>(bytes_, layout_.resolution);
        if (!(resolution > 0 && resolution < 1e3)) return fmt::format("has bins of {:g} m", resolution);
        const double frequency = read<double>(bytes_, layout_.frequency),
                     speed = read<double>(bytes_, layout_.speed_of_sound);
        if (!(frequency >= 0 && frequency < 1e9)) return fmt::format("has a frequency of {:g} Hz", frequency);
        if (!(speed >= 0 && speed < 1e4)) return fmt::format("has a speed of sound of {:g} m/s", speed);
        return "";
    }

    OculusPing ping() const {
        OculusPing ping;
        ping.number = read<uint32_t>(bytes_, layout_.number);
        ping.frequency_hz = read<double>(bytes_, layout_.frequency);
        ping.speed_of_sound = read<double>(bytes_, layout_.speed_of_sound);
        ping.range_resolution = read<double>(bytes_, layout_.resolution);
        const uint8_t gamma = bytes_[gamma_at];
        ping.gamma = gamma == 0 ? 1 : gamma / 255.0;
        ping.bits = static_cast<int>(8 * codeBytes());
        for (size_t beam = 0; beam < beams(); ++beam)  // hundredths of a degree, positive to starboard
            ping.bearings.push_back(types::radians(-0.01 * read<int16_t>(bytes_, layout_.bearings + 2 * beam)));
        readImage(ping);
        return ping;
    }

private:
    size_t beams() const { return read<uint16_t>(bytes_, layout_.beams); }
    size_t bins() const { return read<uint16_t>(bytes_, layout_.bins); }
    size_t codeBytes() const { return size_t{bytes_[layout_.code_size]} + 1; }
    size_t gainBytes() const { return (bytes_[flags_at] & with_row_gains) != 0 ? 4 : 0; }
    size_t rowBytes() const { return gainBytes() + beams() * codeBytes(); }

    /** Rows of all beams, one for each bin, into beams. */
    void readImage(OculusPing& ping) const {
        ping.bin_count = static_cast<uint32_t>(bins());
        ping.codes.resize(beams() * bins());
        const size_t image = read<uint32_t>(bytes_, layout_.image);
        for (size_t k = 0; k < bins(); ++k) {
            const size_t row = image + k * rowBytes();
            if (gainBytes() > 0) ping.row_gains.push_back(read<uint32_t>(bytes_, row));
            for (size_t beam = 0; beam < beams(); ++beam)
                std::memcpy(&ping.codes[beam * bins() + k], bytes_.data() + row + gainBytes() + beam * codeBytes(),
                            codeBytes());
        }
    }

    std::span<const uint8_t> bytes_;
    const Layout& layout_;
};

bool beginsPing(std::span<const uint8_t> bytes) {
    return bytes.size() >= header_size && read<uint16_t>(bytes, 0) == oculus_id &&
           read<uint16_t>(bytes, 6) == ping_result;
}

}  // namespace

std::vector<OculusPing> oculusPings(std::span<const uint8_t> bytes, std::vector<std::string>* diagnostics) {
    std::vector<OculusPing> pings;
    for (size_t at = 0; at + header_size <= bytes.size();) {
        const auto rest = bytes.subspan(at);
        if (!beginsPing(rest)) {
            ++at;
            continue;
        }
        const size_t size = std::min(rest.size(), header_size + read<uint32_t>(rest, 10));
        const Message message(rest.first(size));
        const std::string diagnostic = message.diagnostic();
        if (diagnostic.empty()) pings.push_back(message.ping());
        if (!diagnostic.empty() && diagnostics && diagnostics->size() < max_diagnostics)
            diagnostics->push_back(fmt::format("the ping at byte {} {}", at, diagnostic));
        at += diagnostic.empty() ? size : 2;
    }
    return pings;
}

std::vector<OculusPing> readOculusPings(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream || std::filesystem::is_directory(file))
        throw types::ConfigError(file.string(), "", "cannot be read; it must be a file of Oculus messages");
    const std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(stream), {}};
    std::vector<std::string> diagnostics;
    std::vector<OculusPing> pings = oculusPings(bytes, &diagnostics);
    if (!pings.empty()) return pings;
    if (diagnostics.empty()) throw types::ConfigError(file.string(), "", "holds no ping of an Oculus");
    throw types::ConfigError(file.string(), "", "holds no whole ping: " + diagnostics.front());
}

}  // namespace insonify::device
