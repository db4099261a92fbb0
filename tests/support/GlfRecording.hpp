#pragma once
// .glf files of a Gemini, by the maker's headers and by open programs that read these files.
#include <cstdint>
#include <string>

#include "tests/support/RecordedBytes.hpp"

namespace insonify::test {

/** The content of an image. */
struct GlfImage {
    uint16_t version = 3, device = 1194;
    uint16_t compression = 1;  ///< 0: `packed` is from zlib, 1: uncompressed, 2: H.264.
    uint32_t start_range = 0, end_range = 0;
    uint32_t rate_hz = 37'500;
    float sound_speed = 1500;
    double time_s = 1'400'000'000;  ///< Since 1980.
    uint32_t state = 0;
    uint16_t ping_flags = 0;
    uint8_t platform = 2;
    std::vector<double> bearings{};  ///< Positive to port [rad].
    RecordedBytes packed{};          ///< Samples of 1 byte, all beams of the nearest range first.
    RecordedBytes zoom{};            ///< Follows the image, unless empty.
};

inline RecordedBytes glfHeader(uint8_t type, uint16_t device, double time_s) {
    RecordedBytes bytes;
    putBehind(bytes, '*');
    putBehind(bytes, uint8_t{2});
    putBehind(bytes, uint32_t{168});
    putBehind(bytes, time_s);
    putBehind(bytes, type);
    putBehind(bytes, device);
    putBehind(bytes, uint32_t{100});  // node, spare
    return bytes;
}

inline RecordedBytes glfRecord(const GlfImage& image) {
    RecordedBytes bytes = glfHeader(0, image.device, image.time_s);
    putBehind(bytes, uint16_t{1});
    putBehind(bytes, uint16_t{0xEFEF});
    putBehind(bytes, image.version);
    putBehind(bytes, image.start_range);
    putBehind(bytes, image.end_range);
    putBehind(bytes, uint16_t{0});
    putBehind(bytes, uint32_t{0});
    putBehind(bytes, static_cast<uint32_t>(image.bearings.size()));
    if (image.version == 3) putBehind(bytes, image.compression);
    putBehind(bytes, static_cast<uint32_t>(image.packed.size()));
    bytes.insert(bytes.end(), image.packed.begin(), image.packed.end());
    for (const double bearing : image.bearings) putBehind(bytes, bearing);
    putBehind(bytes, image.state);
    putBehind(bytes, image.rate_hz);
    putBehind(bytes, 120.0f);  // aperture [deg]
    putBehind(bytes, image.time_s);
    putBehind(bytes, image.ping_flags);
    putBehind(bytes, image.sound_speed);
    putBehind(bytes, int16_t{50});
    putBehind(bytes, uint16_t{0x0200});  // no chirp, Mk2
    putBehind(bytes, image.platform);
    putBehind(bytes, uint8_t{!image.zoom.empty()});
    bytes.insert(bytes.end(), image.zoom.begin(), image.zoom.end());
    putBehind(bytes, uint16_t{0xDEDE});
    return bytes;
}

/** Returns a file of an archive. @param method 0: `packed` is the file, 8: it is deflated */
inline RecordedBytes zipped(const std::string& name, const RecordedBytes& packed, uint32_t size, uint32_t checksum,
                            uint16_t method = 0) {
    RecordedBytes bytes(30);
    putAt(bytes, 0, uint32_t{0x04034B50});
    putAt(bytes, 4, uint16_t{20});
    putAt(bytes, 8, method);
    putAt(bytes, 14, checksum);
    putAt(bytes, 18, static_cast<uint32_t>(packed.size()));
    putAt(bytes, 22, size);
    putAt(bytes, 26, static_cast<uint16_t>(name.size()));
    bytes.insert(bytes.end(), name.begin(), name.end());
    bytes.insert(bytes.end(), packed.begin(), packed.end());
    return bytes;
}

/** The checksum of zip archives. */
inline uint32_t zipChecksum(const RecordedBytes& bytes) {
    uint32_t sum = 0xFFFFFFFF;
    for (const char byte : bytes) {
        sum ^= static_cast<uint8_t>(byte);
        for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ (sum & 1 ? 0xEDB88320u : 0);
    }
    return ~sum;
}

/** The bytes of log.dat: these records and the end mark. */
inline RecordedBytes glfLog(std::vector<RecordedBytes> records) {
    records.push_back({'\xDE', '\xDE'});
    return joinedBytes(records);
}

/** An archive with log.cfg and log.dat, both uncompressed. */
inline RecordedBytes glfFile(const std::vector<RecordedBytes>& records) {
    const RecordedBytes settings{'<', '/', '>'}, log = glfLog(records);
    return joinedBytes({zipped("log.cfg", settings, 3, zipChecksum(settings)),
                        zipped("log.dat", log, static_cast<uint32_t>(log.size()), zipChecksum(log))});
}

}  // namespace insonify::test
