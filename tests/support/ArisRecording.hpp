#pragma once
// .aris files by the layout that Sound Metrics publishes (ARIS File SDK, type-definitions).
#include <cstdint>

#include "tests/support/RecordedBytes.hpp"

namespace insonify::test {

constexpr uint32_t aris_mark = 0x05464444;

/** The content of a frame; the angles are from the sonar's compass [deg]. */
struct ArisFrame {
    uint32_t model = 1, ping_mode = 9;  ///< An ARIS 3000 with 128 beams.
    bool is_telephoto = false, is_high = true;
    uint32_t period_us = 10, delay_us = 1000;
    float sound_speed = 1480;
    uint64_t time_us = 1'700'000'000'000'000;
    double latitude = 0, longitude = 0;
    float depth = 0, altitude = 0, heading = 0, pitch = 0, roll = 0;
    RecordedBytes samples{};  ///< 1 byte each, all beams of the nearest range first, from starboard.

    uint32_t beams() const { return ping_mode <= 2 ? 48 : ping_mode <= 5 ? 96 : ping_mode <= 8 ? 64 : 128; }
};

inline RecordedBytes arisHeader() {
    RecordedBytes bytes(1024);
    putAt(bytes, 0, aris_mark);
    return bytes;
}

inline RecordedBytes arisBytes(const ArisFrame& frame) {
    RecordedBytes bytes(1024);
    putAt(bytes, 4, frame.time_us);
    putAt(bytes, 12, aris_mark);
    putAt(bytes, 128, frame.depth);
    putAt(bytes, 132, frame.altitude);
    putAt(bytes, 160, frame.heading);
    putAt(bytes, 164, frame.pitch);
    putAt(bytes, 168, frame.roll);
    putAt(bytes, 172, frame.latitude);
    putAt(bytes, 180, frame.longitude);
    putAt(bytes, 436, frame.ping_mode);
    putAt(bytes, 440, uint32_t{frame.is_high});
    putAt(bytes, 452, frame.period_us);
    putAt(bytes, 464, frame.sound_speed);
    putAt(bytes, 468, static_cast<uint32_t>(frame.samples.size() / frame.beams()));
    putAt(bytes, 476, frame.delay_us);
    putAt(bytes, 480, uint32_t{frame.is_telephoto});
    putAt(bytes, 484, frame.model);
    putAt(bytes, 516, uint32_t{1});
    bytes.insert(bytes.end(), frame.samples.begin(), frame.samples.end());
    return bytes;
}

inline RecordedBytes arisFile(const std::vector<ArisFrame>& frames) {
    std::vector<RecordedBytes> parts{arisHeader()};
    for (const ArisFrame& frame : frames) parts.push_back(arisBytes(frame));
    return joinedBytes(parts);
}

}  // namespace insonify::test
