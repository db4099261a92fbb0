#pragma once
// Recordings of an Oculus: files of the maker's viewer (*.oculus), and captures from the network.
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "components/device/oculus/OculusMessages.hpp"
#include "components/recordings/RecordingReader.hpp"

namespace insonify::device {

/** The beginning of a *.oculus file, without its mark and size. */
struct OculusFileHeader {
    static constexpr size_t size = 48;
    std::array<char, 16> source{'O', 'c', 'u', 'l', 'u', 's'};
    uint16_t version = 1, encryption = 0;
    uint32_t unused = 0;
    int64_t key = 0;
    double time = 0;  ///< Creation time since the epoch [s].
};

/** One record of a *.oculus file. */
struct OculusItem {
    static constexpr size_t header_size = 40;
    static constexpr uint16_t sonar = 10;  ///< As `type`: a message of the device.
    static constexpr uint16_t zipped = 1;  ///< As `compression`: size, big endian, and a zlib stream.
    uint16_t type = sonar, version = 0;
    uint32_t unused_a = 0;
    double time = 0;  ///< Since the epoch [s].
    uint16_t compression = 0, unused_b = 0;
    uint32_t original_size = 0;  ///< Size of the uncompressed payload [B].
    uint32_t unused_c = 0;
    Bytes payload;  ///< As in the file.

    /** Returns the uncompressed payload; none where it is damaged. */
    std::optional<Bytes> content() const;
};

Bytes toBytes(const OculusFileHeader& header);
Bytes toBytes(const OculusItem& item);
/** Returns the item of a message of the device, at a time since the epoch [s]. */
OculusItem getItem(double time, std::span<const uint8_t> message);

/** Reads a *.oculus file item by item; skips damaged parts to the next item. */
class OculusRecording {
public:
    /** Whether a file begins like a *.oculus file. */
    static bool isOne(const std::filesystem::path& file);
    /** Throws types::ConfigError for a file that cannot be read or does not begin like a *.oculus file. */
    explicit OculusRecording(const std::filesystem::path& file);

    const OculusFileHeader& header() const { return header_; }
    /** Returns the next item; none: end of the file. */
    std::optional<OculusItem> next();
    /** The first skipped part, and its place; empty: none. */
    const std::string& diagnostic() const { return diagnostic_; }

private:
    /** Reads at most `size` bytes from the current position. */
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

    /** Adds an item unchanged. Throws std::runtime_error when the system cannot write it. */
    void write(const OculusItem& item) { put(toBytes(item)); }
    /** Adds a message of the device, at a time since the epoch [s]. */
    void write(double time, std::span<const uint8_t> message) { write(getItem(time, message)); }

private:
    void put(const Bytes& bytes);

    std::filesystem::path path_;
    std::ofstream file_;
};

/** A ping of a recording with its time [s]: since the epoch in a *.oculus file; since the first ping, by the device's
 *  clock, in a capture, which has no other clock. */
struct TimedOculusResult {
    double time = 0;
    OculusResult ping;
};

/** Reads the pings of a recording one by one: of a *.oculus file, or of messages captured from the network. */
class OculusPings {
public:
    /** Throws types::ConfigError for a file that cannot be read. */
    explicit OculusPings(const std::filesystem::path& file);
    ~OculusPings();

    std::optional<TimedOculusResult> next();
    /** The first ping that contradicts itself, or the first skipped part of the file; empty: none. */
    const std::string& diagnostic() const { return diagnostic_; }

private:
    struct Source;
    std::unique_ptr<Source> source_;
    size_t number_ = 0;  ///< Number of the last ping that was read, from 1.
    std::string diagnostic_;
};

/** Reads the pings of an Oculus' recording as a receiver's output, see getSonar(). Damaged parts are skipped, with a
 *  notice of the first. The pings have no poses; a capture, which has no times since the epoch, starts at 1 s. */
class OculusReader final : public recordings::RecordingReader {
public:
    /** Throws types::ConfigError for a file that cannot be read. */
    explicit OculusReader(const std::filesystem::path& file) : RecordingReader(file), pings_(file) {}

    std::vector<std::string> notices() const override;

private:
    std::optional<recordings::RecordedPing> read() override;

    OculusPings pings_;
    std::optional<double> begin_;  ///< Time of the first ping, by the clock of the recording [s].
};

}  // namespace insonify::device
