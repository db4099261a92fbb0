#include "components/log/NpzFile.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "types/Check.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::log {
namespace {

constexpr uint16_t zip64_version = 45;
constexpr uint16_t first_of_1980 = 0x21;  // a date is required, and files must not differ by it
constexpr uint32_t see_extra = 0xffffffff;

/** The bytes of a zip record, little endian. */
class Record {
public:
    template <class T>
    Record& put(T value) {
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
        return *this;
    }
    Record& put(const std::string& text) {
        bytes_ += text;
        return *this;
    }
    const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
};

std::string localHeader(const std::string& name, uint32_t crc, uint64_t size) {
    Record record;
    record.put<uint32_t>(0x04034b50).put(zip64_version).put<uint16_t>(0).put<uint16_t>(0);
    record.put<uint16_t>(0).put(first_of_1980).put(crc).put(see_extra).put(see_extra);
    record.put(static_cast<uint16_t>(name.size())).put<uint16_t>(20).put(name);
    record.put<uint16_t>(1).put<uint16_t>(16).put(size).put(size);
    return record.bytes();
}

std::string centralHeader(const std::string& name, uint32_t crc, uint64_t size, uint64_t position) {
    Record record;
    record.put<uint32_t>(0x02014b50).put(zip64_version).put(zip64_version).put<uint16_t>(0).put<uint16_t>(0);
    record.put<uint16_t>(0).put(first_of_1980).put(crc).put(see_extra).put(see_extra);
    record.put(static_cast<uint16_t>(name.size())).put<uint16_t>(28).put<uint16_t>(0).put<uint16_t>(0);
    record.put<uint16_t>(0).put<uint32_t>(0).put(see_extra).put(name);
    record.put<uint16_t>(1).put<uint16_t>(24).put(size).put(size).put(position);
    return record.bytes();
}

std::string endRecords(uint64_t count, uint64_t central_size, uint64_t central) {
    Record record;
    record.put<uint32_t>(0x06064b50).put<uint64_t>(44).put(zip64_version).put(zip64_version);
    record.put<uint32_t>(0).put<uint32_t>(0).put(count).put(count).put(central_size).put(central);
    record.put<uint32_t>(0x07064b50).put<uint32_t>(0).put(central + central_size).put<uint32_t>(1);
    record.put<uint32_t>(0x06054b50).put<uint16_t>(0).put<uint16_t>(0);
    record.put<uint16_t>(0xffff).put<uint16_t>(0xffff).put(see_extra).put(see_extra).put<uint16_t>(0);
    return record.bytes();
}

/** Returns the header of an .npy file, padded so that the data begin at a multiple of 64 bytes. */
std::string npyHeader(const std::string& type, const std::vector<size_t>& shape) {
    INSONIFY_CHECK(type.size() >= 3, type);
    std::string tuple;
    for (const size_t extent : shape) tuple += std::to_string(extent) + ",";
    std::string dictionary = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, tuple);
    const size_t prefix = 10;
    dictionary.resize((prefix + dictionary.size() + 64) / 64 * 64 - prefix - 1, ' ');
    dictionary += '\n';
    Record record;
    record.put(std::string("\x93NUMPY\x01\x00", 8)).put(static_cast<uint16_t>(dictionary.size())).put(dictionary);
    return record.bytes();
}

/** Returns the code points of a UTF-8 text; each byte outside of a complete, shortest sequence is U+FFFD. */
std::u32string codePoints(const std::string& text) {
    constexpr char32_t replacement = 0xFFFD, first_surrogate = 0xD800, last_surrogate = 0xDFFF, last = 0x10FFFF;
    constexpr char32_t shortest[] = {0, 0x80, 0x800, 0x10000};  // by the number of further bytes
    std::u32string points;
    for (size_t at = 0; at < text.size();) {
        const auto lead = static_cast<uint8_t>(text[at]);
        const size_t more = lead < 0x80 ? 0 : lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : 1;
        char32_t point = more == 0 ? lead : lead & (0x3F >> more);
        bool whole = (lead < 0x80 || (lead >= 0xC2 && lead < 0xF5)) && at + more < text.size();
        for (size_t k = 1; whole && k <= more; ++k) {
            const auto next = static_cast<uint8_t>(text[at + k]);
            whole = (next & 0xC0) == 0x80;
            point = point << 6 | (next & 0x3F);
        }
        whole =
            whole && point >= shortest[more] && point <= last && (point < first_surrogate || point > last_surrogate);
        points += whole ? point : replacement;
        at += whole ? more + 1 : 1;
    }
    return points;
}

}  // namespace

NpzFile::NpzFile(const std::filesystem::path& path) : path_(path), file_(path, std::ios::binary) {
    if (!file_) throw types::ConfigError(path, "", "cannot be written: " + std::generic_category().message(errno));
}

void NpzFile::begin(const std::string& name, const std::string& type, const std::vector<size_t>& shape) {
    entries_.push_back({name + ".npy", static_cast<uint64_t>(file_.tellp()), 0, 0});
    file_ << localHeader(entries_.back().name, 0, 0);
    const std::string header = npyHeader(type, shape);
    append(header.data(), header.size());
}

void NpzFile::append(const void* data, size_t size) {
    INSONIFY_CHECK(!entries_.empty());
    if (size == 0) return;  // zlib restarts at a null pointer
    Entry& entry = entries_.back();
    file_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    entry.size += size;
    entry.crc = static_cast<uint32_t>(crc32_z(entry.crc, static_cast<const Bytef*>(data), size));
}

void NpzFile::end() {
    const Entry& entry = entries_.back();
    const auto position = file_.tellp();
    file_.seekp(static_cast<std::streamoff>(entry.position));
    file_ << localHeader(entry.name, entry.crc, entry.size);
    file_.seekp(position);
}

void NpzFile::texts(const std::string& name, const std::vector<size_t>& shape, const std::vector<std::string>& values) {
    std::vector<std::u32string> wide;
    for (const std::string& value : values) wide.push_back(codePoints(value));
    size_t longest = 1;
    for (const std::u32string& text : wide) longest = std::max(longest, text.size());
    begin(name, "<U" + std::to_string(longest), shape);
    for (std::u32string& text : wide) {
        text.resize(longest);
        append(text.data(), longest * sizeof(char32_t));
    }
    end();
}

void NpzFile::close() {
    const auto central = static_cast<uint64_t>(file_.tellp());
    std::string directory;
    for (const Entry& entry : entries_) directory += centralHeader(entry.name, entry.crc, entry.size, entry.position);
    file_ << directory << endRecords(entries_.size(), directory.size(), central);
    file_.close();
    if (!file_) throw std::runtime_error(path_.string() + ": cannot be written: the disk may be full");
}

}  // namespace insonify::log
