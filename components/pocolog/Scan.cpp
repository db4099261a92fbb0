#include "components/pocolog/Scan.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <map>

#include "components/pocolog/Block.hpp"

namespace insonify::pocolog {
namespace {

/** Why the walk over the blocks ends before the end of the file. */
struct Fault : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class Scanner {
public:
    Scanner(int file, Scan& result) : file_(file), result_(result) {}

    /** Takes whole blocks until the file ends or is no log any more. */
    void run() {
        uint64_t position = sizeof(Prologue);
        try {
            while (position < result_.bytes) position = block(position);
        } catch (const Fault& fault) {
            result_.fault = std::string(fault.what()) + " at byte " + std::to_string(position);
        }
    }

private:
    uint64_t block(uint64_t position) {
        BlockHeader header;
        if (!readAt(file_, position, &header, sizeof header)) throw Fault("the file ends within the header of a block");
        const uint64_t payload = position + sizeof header;
        if (header.type < BlockType::Stream || header.type > BlockType::Control) throw Fault("there is no block");
        if (header.size > result_.bytes - payload) throw Fault("the file ends within a block");
        if (header.type == BlockType::Stream) declaration(header, payload);
        if (header.type == BlockType::Data) data(header, payload);
        return payload + header.size;
    }

    void declaration(const BlockHeader& header, uint64_t position) {
        if (index_.contains(header.stream)) return;  // repeated declarations are harmless
        std::vector<char> bytes(header.size);
        if (!readAt(file_, position, bytes.data(), bytes.size())) throw Fault("the file cannot be read");
        Stream stream;
        std::string metadata;
        try {
            Decoder decoder(bytes);
            uint8_t kind = 0;
            decoder.scalar(kind);
            for (std::string* text : {&stream.name, &stream.type, &stream.registry, &metadata})
                takeText(decoder, *text);
        } catch (const std::runtime_error&) {
            throw Fault("the declaration of a stream is damaged");
        }
        stream.metadata = metadataFromYaml(metadata);
        index_[header.stream] = result_.streams.size();
        result_.streams.push_back(std::move(stream));
    }

    static void takeText(Decoder& decoder, std::string& text) {
        uint32_t size = 0;
        decoder.scalar(size);
        if (size > decoder.left()) throw std::runtime_error("too long");
        text.resize(size);
        decoder.bytes(text.data(), size);
    }

    void data(const BlockHeader& header, uint64_t position) {
        const auto stream = index_.find(header.stream);
        if (stream == index_.end()) throw Fault("a sample of a stream that is not declared");
        DataHeader data;
        if (header.size < data_header_size || !readAt(file_, position, &data, data_header_size) ||
            data.size != header.size - data_header_size)
            throw Fault("the sizes of a sample do not agree");
        result_.samples.push_back({stream->second, data.received(), data.time(), position + data_header_size, data.size,
                                   data.compressed != 0});
        count(result_.streams[stream->second], data.time());
    }

    static void count(Stream& stream, types::Time time) {
        if (stream.count++ == 0) stream.first = time;
        stream.last = time;
    }

    int file_;
    Scan& result_;
    std::map<uint16_t, size_t> index_;  ///< From the number in the file to the place in `streams`.
};

void checkPrologue(const Prologue& prologue, const std::filesystem::path& path) {
    if (!std::equal(magic.begin(), magic.end(), prologue.magic_bytes.begin()))
        throw types::ConfigError(path, "", "is not a pocolog file: it does not start with POCOSIM");
    if (prologue.version != format_version)
        throw types::ConfigError(
            path, "",
            "is a pocolog file of version " + std::to_string(prologue.version) + "; only version 2 can be read");
    if (prologue.flags & big_endian_flag)
        throw types::ConfigError(path, "", "was logged on a big-endian machine; only little-endian logs can be read");
}

}  // namespace

bool readAt(int file, uint64_t position, void* to, size_t size) {
    char* next = static_cast<char*>(to);
    while (size > 0) {
        const ssize_t got = pread(file, next, size, static_cast<off_t>(position));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        next += got;
        position += static_cast<uint64_t>(got);
        size -= static_cast<size_t>(got);
    }
    return true;
}

Scan scan(int file, const std::filesystem::path& path) {
    struct stat status {};
    if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) throw types::ConfigError(path, "", "is not a file");
    Scan result;
    result.bytes = static_cast<uint64_t>(status.st_size);
    Prologue prologue;
    const size_t there = std::min<size_t>(result.bytes, sizeof prologue);
    if (there < magic.size() || !readAt(file, 0, &prologue, there))
        throw types::ConfigError(path, "", "is not a pocolog file: it is too short");
    checkPrologue(prologue, path);
    if (there < sizeof prologue)
        result.fault = "the file ends within its prologue";
    else
        Scanner(file, result).run();
    return result;
}

}  // namespace insonify::pocolog
