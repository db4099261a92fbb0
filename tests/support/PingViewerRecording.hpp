#pragma once
// Sensor logs of Ping Viewer, by the layout of its FileLink and LogSensorStruct: a stream of Qt, big endian.
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "components/device/ping/PingProtocol.hpp"
#include "tests/support/RecordedBytes.hpp"

namespace insonify::test {

/** The type of the texts: UTF-16 as Qt writes them, or of 8 bits as in files of Ping Viewer's scripts. */
enum class PingViewerTexts { Wide, Narrow };

inline RecordedBytes bigEndian(uint32_t value) {
    return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
            static_cast<char>(value)};
}

inline RecordedBytes pingViewerText(const std::string& text, PingViewerTexts texts) {
    RecordedBytes letters;
    for (const char letter : text) {
        if (texts == PingViewerTexts::Wide) letters.push_back(0);
        letters.push_back(letter);
    }
    return joinedBytes({bigEndian(static_cast<uint32_t>(letters.size())), letters});
}

inline RecordedBytes pingViewerHeader(PingViewerTexts texts = PingViewerTexts::Wide, uint32_t version = 1) {
    std::vector<RecordedBytes> parts{pingViewerText("PingViewer sensor log file", texts), bigEndian(version)};
    for (const char* text : {"1ed4508", "2024-02-01T11:41:18-03:00", "v2.4.2", "Ubuntu 22.04", "22.04"})
        parts.push_back(pingViewerText(text, texts));
    parts.push_back(bigEndian(1));
    parts.push_back(bigEndian(2));
    return joinedBytes(parts);
}

/** Returns "hh:mm:ss.zzz". */
inline std::string pingViewerTime(double seconds) {
    const long ms = std::lround(std::fmod(seconds, 86400) * 1000);
    return fmt::format("{:02}:{:02}:{:02}.{:03}", ms / 3'600'000, ms / 60'000 % 60, ms / 1000 % 60, ms % 1000);
}

/** @param time empty: none, as Ping Viewer writes after 24 hours */
inline RecordedBytes pingViewerRecord(const std::string& time, const device::Bytes& data,
                                      PingViewerTexts texts = PingViewerTexts::Wide) {
    const RecordedBytes bytes(data.begin(), data.end());
    return joinedBytes({time.empty() ? bigEndian(0xFFFFFFFF) : pingViewerText(time, texts),
                        bigEndian(static_cast<uint32_t>(bytes.size())), bytes});
}

}  // namespace insonify::test
