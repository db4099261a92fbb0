#include "components/device/PingViewerLog.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <ctime>

#include "components/sonars/Sonars.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::device {
namespace {

using recordings::RecordedPing, recordings::RecordedShape;

constexpr const char* title = "PingViewer sensor log file";
constexpr uint32_t no_text = 0xFFFFFFFF;        ///< As the size of a text: there is none.
constexpr size_t time_letters = 12;             ///< Of "hh:mm:ss.zzz".
constexpr size_t max_record = size_t{1} << 20;  ///< Bytes that arrive at once, at most.
constexpr double day = 86400;                   ///< [s]

uint32_t bigEndian(std::span<const uint8_t> bytes, size_t at) {
    return uint32_t{bytes[at]} << 24 | uint32_t{bytes[at + 1]} << 16 | uint32_t{bytes[at + 2]} << 8 | bytes[at + 3];
}

/** Returns a text of UTF-16, big endian, or of 8 bits, of which only the letters of ASCII are kept. */
std::string toText(std::span<const uint8_t> bytes) {
    const bool is_wide = !bytes.empty() && bytes[0] == 0;
    std::string text;
    for (size_t i = is_wide ? 1 : 0; i < bytes.size(); i += is_wide ? 2 : 1) text += static_cast<char>(bytes[i]);
    return text;
}

/** Returns the number of digits such as "07"; -1 for other letters. */
int numberIn(std::string_view digits) {
    int number = 0;
    for (const char digit : digits) {
        if (digit < '0' || digit > '9') return -1;
        number = 10 * number + digit - '0';
    }
    return number;
}

/** Returns the seconds of "hh:mm:ss.zzz"; none for other texts. */
std::optional<double> readSeconds(std::string_view text) {
    if (text.size() != time_letters || text[2] != ':' || text[5] != ':' || text[8] != '.') return std::nullopt;
    const int hours = numberIn(text.substr(0, 2)), minutes = numberIn(text.substr(3, 2)),
              seconds = numberIn(text.substr(6, 2)), ms = numberIn(text.substr(9, 3));
    if (std::min({hours, minutes, seconds, ms}) < 0 || hours > 23 || minutes > 59 || seconds > 59) return std::nullopt;
    return 3600 * hours + 60 * minutes + seconds + ms / 1e3;
}

/** Returns the time in a name such as "20211223-132558123.bin", as UTC; none for other names. */
std::optional<types::Time> beginIn(const std::filesystem::path& file) {
    const std::string name = file.stem().string();
    if (name.size() != 18 || name[8] != '-') return std::nullopt;
    const auto part = [&](size_t at, size_t size) { return numberIn(std::string_view(name).substr(at, size)); };
    std::tm date{};
    date.tm_year = part(0, 4) - 1900;
    date.tm_mon = part(4, 2) - 1;
    date.tm_mday = part(6, 2);
    const int hours = part(9, 2), minutes = part(11, 2), seconds = part(13, 2), ms = part(15, 3);
    const std::tm stated = date;
    const time_t at_midnight = timegm(&date);  // normalises an invalid date
    if (std::min({hours, minutes, seconds, ms}) < 0 || hours > 23 || minutes > 59 || seconds > 59 ||
        date.tm_mon != stated.tm_mon || date.tm_mday != stated.tm_mday || stated.tm_year < 71 || stated.tm_year > 300)
        return std::nullopt;
    return types::Time{((int64_t{at_midnight} + 3600 * hours + 60 * minutes + seconds) * 1000 + ms) * 1000};
}

bool isPing(uint16_t message) {
    return message == Ping360DeviceData::message || message == Ping360AutoDeviceData::message ||
           message == Ping1dProfile::message;
}

/** Whether bytes are one frame by their size, which they may not be by their sum. */
bool isSizedAsFrame(const Bytes& data) {
    constexpr size_t without_payload = 10;
    return data.size() >= without_payload && data[0] == 'B' && data[1] == 'R' &&
           read<uint16_t>(data, 2) + without_payload == data.size();
}

}  // namespace

PingViewerReader::PingViewerReader(const std::filesystem::path& file)
    : RecordingReader(file), named_begin_(beginIn(file)) {
    readHeader();
    const uint64_t begin = next_;
    const Progress at_begin = progress_;
    std::optional<PingFrame> first = nextMessage();
    while (first && !isPing(first->message)) first = nextMessage();
    shape_ = first && first->message == Ping1dProfile::message ? RecordedShape::Sounder : RecordedShape::Scan;
    next_ = begin;
    progress_ = at_begin;
}

Bytes PingViewerReader::bytesAt(uint64_t at, size_t size) {
    const std::vector<char> bytes = take(at, size);
    return {bytes.begin(), bytes.end()};
}

std::string PingViewerReader::readText() {
    constexpr uint32_t longest = 4096;
    const Bytes head = bytesAt(next_, sizeof(uint32_t));
    const uint32_t stated = head.size() == sizeof(uint32_t) ? bigEndian(head, 0) : 0;
    const uint32_t size = stated == no_text ? 0 : stated;
    if (head.size() < sizeof(uint32_t) || size > longest || next_ + head.size() + size > size_)
        fail(next_, fmt::format("is no text of the header of a log of Ping Viewer; it must have at most {} bytes and "
                                "end within the file",
                                longest));
    const std::string text = toText(bytesAt(next_ + head.size(), size));
    next_ += head.size() + size;
    return text;
}

void PingViewerReader::readHeader() {
    constexpr size_t number = sizeof(uint32_t), program_texts = 5;
    if (const std::string text = readText(); text != title)
        fail(0, fmt::format("does not begin with the text '{}', nor as another recording does; may be a {} file", title,
                            recordings::recordingEndings()));
    const auto readNumber = [&](const char* what) {
        const Bytes bytes = bytesAt(next_, number);
        if (bytes.size() < number) fail(next_, fmt::format("ends here; the {} follows", what));
        next_ += number;
        return bigEndian(bytes, 0);
    };
    const uint64_t at_version = next_;
    if (const uint32_t version = readNumber("version of the log"); version != 1)
        fail(at_version, fmt::format("is version {} of the log; 1 is read", version));
    for (size_t i = 0; i < program_texts; ++i) readText();
    readNumber("family of the sensor");
    readNumber("type of the sensor");
}

std::optional<PingViewerReader::Record> PingViewerReader::recordAt(uint64_t at) {
    constexpr size_t sizes = 2 * sizeof(uint32_t);
    const Bytes head = bytesAt(at, sizes + 2 * time_letters);
    if (head.size() < sizes) return std::nullopt;
    const uint32_t stated = bigEndian(head, 0);
    const size_t text = stated == no_text ? 0 : stated;
    if ((text != 0 && text != time_letters && text != 2 * time_letters) || head.size() < sizes + text)
        return std::nullopt;
    Record record;
    record.seconds = readSeconds(toText(std::span(head).subspan(sizeof(uint32_t), text)));
    const size_t size = bigEndian(head, sizeof(uint32_t) + text);
    record.end = at + sizes + text + size;
    if ((text > 0 && !record.seconds) || size > max_record || record.end > size_) return std::nullopt;
    record.data = bytesAt(at + sizes + text, size);
    const bool begins_message = size > 1 && record.data[0] == 'B' && record.data[1] == 'R';
    if (text == 0 && !begins_message) return std::nullopt;
    return record;
}

std::optional<PingViewerReader::Record> PingViewerReader::nextRecord() {
    if (next_ >= size_) return std::nullopt;
    at_ = next_;
    std::optional<Record> record = recordAt(at_);
    constexpr size_t block = 1 << 16, overlap = 64;
    for (uint64_t from = at_ + 1; !record && from < size_; from += block) {
        const Bytes bytes = bytesAt(from, block + overlap);
        for (size_t i = 0; !record && i < std::min(bytes.size(), block); ++i) {
            const bool may_begin = i + sizeof(uint32_t) < bytes.size() &&
                                   (bytes[i + 3] == time_letters || bytes[i + 3] == 2 * time_letters);
            if (may_begin && bigEndian(bytes, i) == bytes[i + 3]) record = recordAt(from + i);
            if (!record) continue;
            omit(progress_.between, fmt::format("byte {}", at_));
            progress_.between_records += from + i - at_;
            at_ = from + i;
        }
    }
    if (!record) omit(progress_.cut_off, fmt::format("byte {}", at_));
    next_ = record ? record->end : size_;
    return record;
}

void PingViewerReader::setTime(const std::optional<double>& seconds) {
    if (!seconds) return void(++progress_.timeless);
    double& now = progress_.seconds;
    const double in_day = std::fmod(now, day);
    now += *seconds - in_day + (*seconds < in_day - day / 2 ? day : 0);
}

std::optional<PingFrame> PingViewerReader::nextMessage() {
    for (;;) {
        if (auto frame = progress_.frames.next()) return frame;
        const std::optional<Record> record = nextRecord();
        if (!record) return std::nullopt;
        setTime(record->seconds);
        const bool is_alone = progress_.frames.waiting() == 0 && isSizedAsFrame(record->data);
        if (is_alone && pingFrames(record->data, max_payload).empty())
            omit(progress_.damaged, fmt::format("in the record at byte {}", at_));
        else
            progress_.frames.add(record->data);
    }
}

void PingViewerReader::omit(Omitted& kind, const std::string& why) {
    if (kind.count++ == 0) kind.first = why;
}

std::optional<RecordedPing> PingViewerReader::read() {
    while (const auto frame = nextMessage())
        if (auto ping = makePing(*frame)) return ping;
    return std::nullopt;
}

std::optional<RecordedPing> PingViewerReader::makePing(const PingFrame& frame) {
    const auto with = [&]<class Message>(std::type_identity<Message>, auto&& use) -> std::optional<RecordedPing> {
        if (const auto message = pingMessage<Message>(frame)) return use(*message);
        omit(progress_.odd, fmt::format("message {} in the record at byte {} is too short", frame.message, at_));
        return std::nullopt;
    };
    const auto scan = [&](const auto& message) { return scanned(message.angle, message.acoustics, message.data); };
    const bool is_scan = shape_ == RecordedShape::Scan;
    if (is_scan && frame.message == Ping360DeviceData::message)
        return with(std::type_identity<Ping360DeviceData>{}, scan);
    if (is_scan && frame.message == Ping360AutoDeviceData::message)
        return with(std::type_identity<Ping360AutoDeviceData>{}, scan);
    if (!is_scan && frame.message == Ping1dProfile::message)
        return with(std::type_identity<Ping1dProfile>{}, [&](const auto& message) { return sounded(message); });
    if (const auto speed = pingMessage<Ping1dSpeedOfSound>(frame); speed && speed->value > 0)
        progress_.speed_of_sound = speed->value / 1e3;
    ++progress_.other[frame.message];
    return std::nullopt;
}

namespace {

/** Sets what the pings of one device have in common. */
void setDevice(const char* name, RecordedPing& read) {
    const sonars::SonarMode& mode = sonars::sonar(name).modes.front();
    read.ping.beam_width = types::Angle::fromDeg(mode.beam_width_deg);
    read.ping.beam_height = types::Angle::fromDeg(mode.beam_height_deg);
    read.sonar.position.x = types::Pose::unknown;
}

std::span<const char> toChars(const Bytes& data) { return {reinterpret_cast<const char*>(data.data()), data.size()}; }

}  // namespace

std::optional<RecordedPing> PingViewerReader::scanned(uint16_t angle, const Ping360Acoustics& acoustics,
                                                      const Bytes& data) {
    constexpr double ahead = 200, tick = 25e-9;  // [gradian], [s]
    const Ping360Config device;
    if (data.empty()) return omit(progress_.silent), std::nullopt;
    if (angle >= 400 || acoustics.sample_period == 0 || acoustics.gain >= device.gain_db.size()) {
        omit(progress_.odd,
             fmt::format("in the record at byte {} the angle is {}, at most 399, the sample period {}, at least 1, "
                         "and the gain {}, at most 2",
                         at_, angle, acoustics.sample_period, acoustics.gain));
        return std::nullopt;
    }
    RecordedPing read;
    read.ping.time = named_begin_.value_or(types::Time{1'000'000}) + types::Time::fromSeconds(progress_.seconds);
    setDevice("ping360", read);
    read.frequency_khz = acoustics.frequency_khz;
    read.gain_db = device.gain_db[acoustics.gain];
    setResolution(acoustics.sample_period * tick * usual_speed / 2, usual_speed, read);
    const double bearing = ping360Bearing(angle, ahead).rad;
    setFan(std::span(&bearing, 1), 0, toChars(data), read);
    return read;
}

std::optional<RecordedPing> PingViewerReader::sounded(const Ping1dProfile& profile) {
    const Ping1dMeasurement& made = profile.measurement;
    if (profile.data.empty()) return omit(progress_.silent), std::nullopt;
    constexpr double max_bins = 65535;
    const double sample = made.length / 1e3 / static_cast<double>(profile.data.size());
    const double first = std::round(made.start / 1e3 / sample);  // not finite without a length
    if (!(first + static_cast<double>(profile.data.size()) <= max_bins)) {
        omit(progress_.odd, fmt::format("in the record at byte {} the scan begins at {} mm and is {} mm long; it must "
                                        "have a length, and begin at most {:g} samples from the sonar",
                                        at_, made.start, made.length, max_bins));
        return std::nullopt;
    }
    RecordedPing read;
    read.ping.time = named_begin_.value_or(types::Time{1'000'000}) + types::Time::fromSeconds(progress_.seconds);
    setDevice("ping1d", read);
    if (made.gain <= ping1d_max_gain) read.gain_db = ping1dGainDb(made.gain);
    setResolution(sample, progress_.speed_of_sound, read);
    const double ahead = 0;
    setFan(std::span(&ahead, 1), static_cast<uint32_t>(first), toChars(profile.data), read);
    read.window_start = first * sample;
    read.number = made.ping_number;
    if (made.confidence > 0) read.altitude = made.distance / 1e3;
    return read;
}

std::vector<std::string> PingViewerReader::notices() const {
    std::vector<std::string> all = RecordingReader::notices();
    all.push_back(named_begin_
                      ? "the beginning of the log is that in its name, read as UTC"
                      : "the log states no date, and neither does its name (yyyyMMdd-hhmmsszzz.bin): it begins "
                        "1 s after 1970");
    if (shape_ == RecordedShape::Scan)
        all.push_back(fmt::format("the log states no speed of sound: ranges are those at {:g} m/s", usual_speed));
    const auto report = [&](const Omitted& omitted, const std::string& what) {
        if (omitted.count == 0) return;
        all.push_back(
            fmt::format("{} {}{}", omitted.count, what, omitted.first.empty() ? "" : "; the first: " + omitted.first));
    };
    report(progress_.damaged, "messages have a wrong checksum and are omitted");
    report(progress_.odd, "messages contradict themselves and are omitted");
    report(progress_.silent, "messages have no echoes and are omitted");
    report(progress_.between, fmt::format("places have bytes that are no record, {} in all, which are omitted",
                                          progress_.between_records));
    report(progress_.cut_off, "records are cut off by the end of the file");
    if (const size_t rest = progress_.frames.skipped() + progress_.frames.waiting(); rest > 0)
        all.push_back(fmt::format("{} bytes between messages are omitted", rest));
    if (progress_.timeless > 0)
        all.push_back(fmt::format("{} records have no time, as after 24 hours, and get that of the record before",
                                  progress_.timeless));
    for (const auto& [message, count] : progress_.other)
        all.push_back(fmt::format("{} messages {} are omitted", count, message));
    return all;
}

}  // namespace insonify::device
