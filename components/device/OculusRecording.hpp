#pragma once
// Recordings of an Oculus: files of the maker's viewer (*.oculus), and what was captured from the network.
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "components/device/OculusMessages.hpp"

namespace insonify::device {

/** How a *.oculus file begins, without its mark and size. */
struct OculusFileHeader {
    static constexpr size_t size = 48;
    std::array<char, 16> source{'O', 'c', 'u', 'l', 'u', 's'};
    uint16_t version = 1, encryption = 0;
    uint32_t unused = 0;
    int64_t key = 0;
    double time = 0;  ///< Of its making, since the epoch [s].
};

/** One record of such a file. */
struct OculusItem {
    static constexpr size_t header_size = 40;
    static constexpr uint16_t sonar = 10;  ///< As `type`: a message of the device.
    static constexpr uint16_t zipped = 1;  ///< As `compression`: size, big endian, and a zlib stream.
    uint16_t type = sonar, version = 0;
    uint32_t unused_a = 0;
    double time = 0;  ///< Since the epoch [s].
    uint16_t compression = 0, unused_b = 0;
    uint32_t original_size = 0;  ///< Of the payload, before compression [B].
    uint32_t unused_c = 0;
    Bytes payload;  ///< As it stands in the file.

    /** The payload, unpacked; none where it is damaged. */
    std::optional<Bytes> content() const;
};

/** Reads a *.oculus file, item by item. Looks for the next item behind what is none. */
class OculusRecording {
public:
    /** Whether a file begins as one. */
    static bool isOne(const std::filesystem::path& file);
    /** Throws types::ConfigError for a file that cannot be read or does not begin as one. */
    explicit OculusRecording(const std::filesystem::path& file);

    const OculusFileHeader& header() const { return header_; }
    /** The next item; none: the file is at its end. */
    std::optional<OculusItem> next();
    /** What was passed over first, and where; empty: nothing. */
    const std::string& diagnostic() const { return diagnostic_; }

private:
    /** Up to so many bytes from where the file is read. */
    Bytes take(size_t size);
    void passOver();

    std::ifstream file_;
    uint64_t size_ = 0, at_ = 0;
    OculusFileHeader header_;
    std::string diagnostic_;
};

/** Writes a *.oculus file. */
class OculusRecorder {
public:
    /** Throws types::ConfigError where the file cannot be made. */
    OculusRecorder(const std::filesystem::path& file, const OculusFileHeader& header);

    /** Adds an item as it is. Throws std::runtime_error where the system takes no more. */
    void write(const OculusItem& item);
    /** Adds a message of the device, at seconds since the epoch. */
    void write(double time, std::span<const uint8_t> message);

private:
    void put(const Bytes& bytes);

    std::filesystem::path path_;
    std::ofstream file_;
};

/** A ping of a recording, and when it was sent [s]: since the epoch in a *.oculus file, since the first ping by the
 *  device's own clock in a capture, which has no other. */
struct RecordedPing {
    double time = 0;
    OculusResult ping;
};

/** The pings of a recording, one after the other: of a *.oculus file, or of messages as they came from the network. */
class OculusPings {
public:
    /** Throws types::ConfigError for a file that cannot be read. */
    explicit OculusPings(const std::filesystem::path& file);
    ~OculusPings();

    std::optional<RecordedPing> next();
    /** The first ping that contradicts itself, or what of the file was passed over; empty: none. */
    const std::string& diagnostic() const { return diagnostic_; }

private:
    struct Source;
    std::unique_ptr<Source> source_;
    size_t number_ = 0;  ///< Of the ping that was looked at last, from 1.
    std::string diagnostic_;
};

}  // namespace insonify::device
