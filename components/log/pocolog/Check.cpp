#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "components/log/Files.hpp"
#include "components/log/pocolog/BlockFile.hpp"
#include "components/log/pocolog/Reader.hpp"
#include "components/log/pocolog/Typelib.hpp"
#include "components/log/pocolog/Wire.hpp"
#include "types/Time.hpp"

namespace insonify::log::pocolog {
namespace {

/** "0x50 ('P')" */
std::string shown(char byte) {
    const auto value = static_cast<unsigned char>(byte);
    return fmt::format("0x{:02x}", value) + (value > ' ' && value < 0x7f ? fmt::format(" ('{}')", byte) : "");
}

/** Throws FormatError at the first byte that is not as expected. */
void requireBytes(std::span<const char> found, std::span<const char> expected, const char* whose) {
    const auto [is, must] = std::mismatch(found.begin(), found.end(), expected.begin(), expected.end());
    const auto byte = static_cast<uint64_t>(is - found.begin());
    if (is == found.end() && must == expected.end()) return;
    if (is == found.end())
        throw FormatError(byte, fmt::format("the file ends; {} must have {} bytes", whose, expected.size()));
    if (must == expected.end()) throw FormatError(byte, fmt::format("{} must end here", whose));
    throw FormatError(byte, fmt::format("is {}; in {} it must be {}", shown(*is), whose, shown(*must)));
}

class Checker {
public:
    explicit Checker(const std::filesystem::path& path) : path_(path), file_(path) {}

    Verdict run() {
        Verdict verdict;
        std::filesystem::path file = path_;
        try {
            log();
            file = indexPath(path_);
            if (std::filesystem::exists(file)) index(file);
        } catch (const FormatError& error) {
            verdict.diagnostic = {file, error.byte, error.what()};
        }
        verdict.streams = streams_.size();
        for (const Seen& stream : streams_) {
            verdict.samples += stream.index.samples.size();
            verdict.set_backs += stream.declared.set_backs;
        }
        return verdict;
    }

private:
    struct Seen {
        Stream declared;
        StreamIndex index;
        types::Time last;
    };

    void log() {
        prologue();
        for (uint64_t block = sizeof(Prologue); block < file_.size();) {
            const BlockHeader header = file_.header(block);
            if (header.type == BlockType::Stream) declaration(block, header);
            if (header.type == BlockType::Data) sample(block, header);
            block += sizeof header + header.size;
        }
    }

    void prologue() {
        std::vector<char> found(std::min<size_t>(file_.size(), sizeof(Prologue)));
        file_.read(0, found.data(), found.size());
        std::vector<char> expected(magic.begin(), magic.end());
        Encoder encoder(expected);
        encoder.scalar(format_version);
        encoder.scalar(uint32_t{0});
        requireBytes(found, expected, "the prologue of a little-endian log of version 2");
    }

    void declaration(uint64_t block, const BlockHeader& header) {
        if (header.stream != streams_.size())
            throw FormatError(
                block + offsetof(BlockHeader, stream),
                fmt::format("declares stream {}; it must be {}: in order, each once", header.stream, streams_.size()));
        Declaration stream = file_.declaration(block, header);
        const uint64_t end = stream.yaml_at + stream.yaml.size();
        if (end != block + sizeof header + header.size)
            throw FormatError(end, fmt::format("the declaration of {} must end here", stream.name));
        const auto same = [&](const Seen& other) { return other.declared.name == stream.name; };
        if (stream.name.empty() || std::any_of(streams_.begin(), streams_.end(), same))
            throw FormatError(stream.name_at,
                              fmt::format("a stream is named '{}'; each must have a unique name", stream.name));
        if (stream.type.empty()) throw FormatError(stream.type_at, fmt::format("the type of {} is empty", stream.name));
        if (!declares(stream.registry, stream.type))
            throw FormatError(stream.registry_at, fmt::format("the registry of {} must be typelib's XML with {} in it",
                                                              stream.name, stream.type));
        metadata(stream);
        const auto sample = findSample(stream.type);
        streams_.push_back({{stream.name, stream.type, sample}, {.declaration = block}, {}});
    }

    /** Typelib writes attributes in double quotes from C++, in single quotes from Ruby. */
    static bool declares(const std::string& registry, const std::string& type) {
        const auto holds = [&](const std::string& text) { return registry.find(text) != registry.npos; };
        const std::string name = xmlEscaped(type);
        return holds("<typelib>") && holds("</typelib>") &&
               (holds("name=\"" + name + '"') || holds("name='" + name + '\''));
    }

    /** Rock's C++ reader ends the process if the metadata are not a flat map. */
    static void metadata(const Declaration& found) {
        if (const std::optional<size_t> at = findNotFlat(found.yaml))
            throw FormatError(found.yaml_at + *at,
                              fmt::format("the metadata of {} must be a flat map of scalars", found.name));
    }

    void sample(uint64_t block, const BlockHeader& header) {
        if (header.stream >= streams_.size())
            throw FormatError(block + offsetof(BlockHeader, stream),
                              fmt::format("a sample of stream {}; declared are {}", header.stream, streams_.size()));
        const DataHeader data = file_.data(block, header);
        times(streams_[header.stream], block, data);
        content(streams_[header.stream].declared, block + sizeof header + data_header_size, data);
    }

    /** Whether a time may follow another: it is not before it, unless the clock was set back. */
    static bool isNext(types::Time time, types::Time before) {
        return time >= before || before - time > types::max_lateness;
    }

    static void times(Seen& stream, uint64_t block, const DataHeader& data) {
        const uint64_t header = block + sizeof(BlockHeader);
        const auto require = [&](bool holds, size_t offset, const char* what) {
            if (!holds) throw FormatError(header + offset, fmt::format("in {} {}", stream.declared.name, what));
        };
        const bool first = stream.index.samples.empty();
        require(data.received_us < 1'000'000, offsetof(DataHeader, received_us), "there must be less than 1000000 us");
        require(data.time_us < 1'000'000, offsetof(DataHeader, time_us), "there must be less than 1000000 us");
        require(first || isNext(data.received(), stream.index.last_received), offsetof(DataHeader, received_s),
                "the time of logging must not run backwards");
        require(first || isNext(data.time(), stream.last), offsetof(DataHeader, time_s), "time must not run backwards");
        require(data.compressed <= 1, offsetof(DataHeader, compressed), "the flag may be 0, or 1 for compressed");
        if (!first && data.time() < stream.last) ++stream.declared.set_backs;
        if (first) stream.index.first_received = data.received();
        stream.index.last_received = data.received();
        stream.last = data.time();
        stream.index.samples.push_back({block, data.time()});
    }

    void content(const Stream& stream, uint64_t position, const DataHeader& data) {
        bytes_.resize(data.size);
        if (!file_.read(position, bytes_.data(), bytes_.size())) throw FormatError(position, "the file cannot be read");
        try {
            if (data.compressed) inflateTo(inflated_, bytes_);
            if (stream.sample) sample(*stream.sample, data.compressed ? inflated_ : bytes_);
        } catch (const FormatError& error) {
            throw FormatError(position + (data.compressed ? 0 : error.byte),
                              fmt::format("a sample of {} {}", stream.name, error.what()));
        }
    }

    void sample(size_t type, std::span<const char> bytes) {
        const types::SampleRoom room = roomFor(type, samples_);
        decode(bytes, room);
        const auto diagnostic = [](auto* held) { return types::findDiagnostic(*held); };
        if (const char* what = std::visit(diagnostic, room)) throw FormatError(0, what);
    }

    void index(const std::filesystem::path& path) const {
        constexpr size_t modified = 13 + sizeof(uint32_t) + sizeof(uint64_t);  // place of the log's modification time
        std::vector<StreamIndex> streams;
        for (const Seen& stream : streams_) streams.push_back(stream.index);
        std::vector<char> expected = indexBytes(streams, file_.size(), {});
        std::ifstream stream(path, std::ios::binary);
        const std::vector<char> found{std::istreambuf_iterator<char>(stream), {}};
        if (found.size() >= modified + sizeof(uint64_t))
            std::copy_n(found.begin() + modified, sizeof(uint64_t), expected.begin() + modified);
        requireBytes(found, expected, "the index of this log");
    }

    std::filesystem::path path_;
    BlockFile file_;
    std::vector<Seen> streams_;
    std::vector<char> bytes_, inflated_;
    types::SampleTypes samples_;  ///< Reused for decoding.
};

}  // namespace

Verdict check(const std::filesystem::path& path) { return Checker(path).run(); }

}  // namespace insonify::log::pocolog
