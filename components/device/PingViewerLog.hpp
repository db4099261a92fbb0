#pragma once
// Sensor logs of Ping Viewer (*.bin): the bytes that a Blue Robotics Ping360 or Ping1D sent, with times.
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "components/device/ping/Ping1dEmulator.hpp"
#include "components/device/ping/Ping360Emulator.hpp"
#include "components/recordings/RecordingReader.hpp"

namespace insonify::device {

/** Reads the pings of a sensor log of Ping Viewer as a receiver's codes of 8 bits: those of a Ping360 (messages 2300
 *  and 2301), each at the bearing of its head, or those of a Ping1D (message 1300), with the distance as altitude. The
 *  first such message decides; other messages are omitted, with a notice.
 *
 *  A file is a stream of Qt, big endian, in which a text or an array follows its size in bytes (u32; 0xFFFFFFFF:
 *  none), and texts are UTF-16: the text "PingViewer sensor log file", the version 1 (u32), five texts on the program
 *  and its system, the sensor's family and type (i32); then records of a time, as text "hh:mm:ss.zzz", and the bytes
 *  that arrived then. (Ping Viewer's FileLink and LogSensorStruct; its decode_sensor_binary_log.py also reads and
 *  writes texts of 8 bits.) Messages may begin and end anywhere in the records.
 *
 *  A time counts from the beginning of the log, which is in the file's name, "yyyyMMdd-hhmmsszzz.bin", and is read as
 *  UTC; under another name the log begins 1 s after 1970. Where times go back by more than 12 hours a day has passed. A
 *  record without a time, which Ping Viewer writes after 24 hours, has that of the record before.
 *
 *  The pings have no poses. Bins of a Ping360 count time: their ranges are those at 1500 m/s. Those of a Ping1D are by
 *  the speed of sound that the device reports (message 1203), 1500 m/s before. The frequency of a Ping1D is not stated,
 * and unknown. */
class PingViewerReader final : public recordings::RecordingReader {
public:
    /** Throws types::ConfigError for a file that cannot be read, or does not begin as a log of Ping Viewer. */
    explicit PingViewerReader(const std::filesystem::path& file);

    std::vector<std::string> notices() const override;

private:
    struct Record {
        std::optional<double> seconds;  ///< Since the beginning of the log.
        Bytes data;
        uint64_t end = 0;  ///< Offset of the next record [B].
    };
    /** Messages or records that are omitted, and the place and the reason of the first. */
    struct Omitted {
        size_t count = 0;
        std::string first;
    };
    static constexpr size_t max_payload = 10'240;  ///< Of a message, as in Ping Viewer's own parser [B].
    static constexpr double usual_speed = 1500;    ///< Of sound, as drivers assume [m/s].
    /** What was found up to a place in the file. */
    struct Progress {
        PingFrameReader frames{max_payload};
        double seconds = 0;                   ///< Time of the record, since the beginning of the log.
        double speed_of_sound = usual_speed;  ///< By which a Ping1D computes distances [m/s].
        size_t timeless = 0;                  ///< Records without a time.
        uint64_t between_records = 0;         ///< Omitted bytes.
        std::map<uint16_t, size_t> other;     ///< Messages of other numbers.
        Omitted damaged, odd, silent, cut_off, between;
    };

    std::optional<recordings::RecordedPing> read() override;
    void readHeader();
    /** Returns the next text of the header. */
    std::string readText();
    Bytes bytesAt(uint64_t at, size_t size);
    /** Returns the record at an offset; none if there is no whole record. */
    std::optional<Record> recordAt(uint64_t at);
    /** Returns the next record; passes over bytes between records. None at the end of the file. */
    std::optional<Record> nextRecord();
    /** Returns the next message; none at the end of the file. */
    std::optional<PingFrame> nextMessage();
    void setTime(const std::optional<double>& seconds);
    std::optional<recordings::RecordedPing> makePing(const PingFrame& frame);
    std::optional<recordings::RecordedPing> scanned(uint16_t angle, const Ping360Acoustics& acoustics,
                                                    const Bytes& data);
    std::optional<recordings::RecordedPing> sounded(const Ping1dProfile& profile);
    void omit(Omitted& kind, const std::string& why = "");

    const std::optional<types::Time> named_begin_;  ///< Of the log, as its name states it.
    Progress progress_;
};

}  // namespace insonify::device
