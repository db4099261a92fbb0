#pragma once
// A ping in the format of an Oculus, byte by byte.
#include <cstdint>
#include <cstring>
#include <functional>
#include <vector>

namespace insonify::test {

using Bytes = std::vector<uint8_t>;

/** Writes a value at its place, little endian, and extends the message if needed. */
template <class T>
void put(Bytes& bytes, size_t at, T value) {
    if (bytes.size() < at + sizeof value) bytes.resize(at + sizeof value);
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

/** A simple ping result over 60 degrees with bins of 0.25 m, at gamma 127. */
struct OculusMessage {
    uint16_t version = 1, beams = 3, bins = 2;
    uint8_t code_bytes = 1;
    bool gains = false;  ///< One per row, from 9 on.
    uint32_t number = 77;
    std::function<uint8_t(size_t beam, size_t bin)> code = [](size_t beam, size_t bin) {
        return static_cast<uint8_t>(10 * beam + bin);
    };

    Bytes bytes() const {
        const size_t shift = version == 2 ? 36 : 0, late = version == 2 ? 64 : 0;
        const size_t image_fields = version == 2 ? 190 : 110, bearings = version == 2 ? 202 : 122;
        const auto image = static_cast<uint32_t>(bearings + 2 * beams);
        Bytes message(16);
        put<uint16_t>(message, 0, 0x4F53);
        put<uint16_t>(message, 6, 0x23);
        put<uint16_t>(message, 8, version);
        put<uint8_t>(message, 19, 127);
        put<uint8_t>(message, 20, gains ? 0x1D : 0x19);
        put<uint32_t>(message, 53 + shift, number);
        put<double>(message, 61 + shift, 2.1e6);
        put<double>(message, version == 2 ? 145 : 85, 1490.5);
        put<uint8_t>(message, 97 + late, static_cast<uint8_t>(code_bytes - 1));
        put<double>(message, 98 + late, 0.25);
        put<uint16_t>(message, 106 + late, bins);
        put<uint16_t>(message, 108 + late, beams);
        put<uint32_t>(message, image_fields, image);
        put<uint32_t>(message, image_fields + 4, static_cast<uint32_t>(bins * rowBytes()));
        for (size_t beam = 0; beam < beams; ++beam)
            put<int16_t>(message, bearings + 2 * beam,
                         static_cast<int16_t>(-3000 + 6000 * static_cast<int>(beam) / (beams - 1)));
        putImage(message, image);
        put<uint32_t>(message, 10, static_cast<uint32_t>(message.size() - 16));
        return message;
    }

private:
    size_t rowBytes() const { return (gains ? 4 : 0) + size_t{beams} * code_bytes; }

    /** Writes the image; the upper bytes of wide codes are 1. */
    void putImage(Bytes& message, size_t image) const {
        for (size_t bin = 0; bin < bins; ++bin) {
            const size_t row = image + bin * rowBytes();
            if (gains) put<uint32_t>(message, row, static_cast<uint32_t>(9 + bin));
            for (size_t beam = 0; beam < beams; ++beam)
                for (size_t byte = 0; byte < code_bytes; ++byte)
                    put<uint8_t>(message, row + (gains ? 4 : 0) + beam * code_bytes + byte,
                                 byte == 0 ? code(beam, bin) : uint8_t{1});
        }
    }
};

}  // namespace insonify::test
