#include "components/log/pocolog/BlockFile.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <vector>

#include "components/log/pocolog/Reader.hpp"
#include "components/log/pocolog/Wire.hpp"

namespace insonify::log::pocolog {
namespace {

/** Reads a text of a declaration and returns its position. */
uint64_t readText(Decoder& decoder, uint64_t payload, const char* what, std::string& text) {
    const uint64_t count_at = payload + decoder.taken();
    uint32_t size = 0;
    if (decoder.left() < sizeof size)
        throw FormatError(count_at, fmt::format("the declaration of a stream is damaged: it ends before its {}", what));
    decoder.scalar(size);
    if (size > decoder.left())
        throw FormatError(count_at,
                          fmt::format("the declaration of a stream is damaged: its {} has {} bytes, {} are left", what,
                                      size, decoder.left()));
    text.resize(size);
    decoder.bytes(text.data(), size);
    return count_at + sizeof size;
}

struct Inflation {
    z_stream stream{};
    Inflation() {
        if (inflateInit(&stream) != Z_OK) throw FormatError(0, "cannot be decompressed: no memory");
    }
    ~Inflation() { inflateEnd(&stream); }
};

}  // namespace

BlockHeader BlockFile::header(uint64_t block) const {
    BlockHeader header;
    if (!read(block, &header, sizeof header)) throw FormatError(size(), "the file ends within the header of a block");
    if (header.type < BlockType::Stream || header.type > BlockType::Control)
        throw FormatError(block,
                          fmt::format("there is no block: its type is {}, it may be 1 (a stream), 2 (a sample) or 3 "
                                      "(control)",
                                      static_cast<int>(header.type)));
    const uint64_t left = size() - block - sizeof header;
    if (header.size > left)
        throw FormatError(block + offsetof(BlockHeader, size),
                          fmt::format("the file ends within a block: it has {} bytes, {} are left", header.size, left));
    return header;
}

Declaration BlockFile::declaration(uint64_t block, const BlockHeader& header) const {
    const uint64_t payload = block + sizeof header;
    std::vector<char> bytes(header.size);
    if (!read(payload, bytes.data(), bytes.size())) throw FormatError(payload, "the file cannot be read");
    if (bytes.empty() || bytes[0] != 1)
        throw FormatError(payload, "the declaration of a stream is damaged: its kind may be 1 (of samples)");
    Decoder decoder(std::span<const char>(bytes).subspan(1));
    Declaration found;
    found.name_at = readText(decoder, payload + 1, "name", found.name);
    found.type_at = readText(decoder, payload + 1, "type", found.type);
    found.registry_at = readText(decoder, payload + 1, "registry", found.registry);
    found.yaml_at = readText(decoder, payload + 1, "metadata", found.yaml);
    return found;
}

DataHeader BlockFile::data(uint64_t block, const BlockHeader& header) const {
    const uint64_t payload = block + sizeof header;
    DataHeader data;
    if (header.size < data_header_size || !read(payload, &data, data_header_size))
        throw FormatError(block + offsetof(BlockHeader, size),
                          fmt::format("the sizes of a sample do not agree: its block has {} bytes, {} are its header",
                                      header.size, data_header_size));
    if (data.size != header.size - data_header_size)
        throw FormatError(payload + offsetof(DataHeader, size),
                          fmt::format("the sizes of a sample do not agree: it has {} bytes, its block leaves it {}",
                                      data.size, header.size - data_header_size));
    return data;
}

void inflateTo(std::vector<char>& out, std::vector<char>& in) {
    Inflation inflation;
    z_stream& z = inflation.stream;
    z.next_in = reinterpret_cast<Bytef*>(in.data());
    z.avail_in = static_cast<uInt>(in.size());
    out.clear();
    for (int status = Z_OK; status != Z_STREAM_END;) {
        const size_t before = out.size();
        out.resize(std::min<size_t>(std::max<size_t>(2 * before, 4 * in.size() + 64), uint32_t(-1)));
        z.next_out = reinterpret_cast<Bytef*>(out.data()) + before;
        z.avail_out = static_cast<uInt>(out.size() - before);
        status = inflate(&z, Z_NO_FLUSH);
        if (status != Z_STREAM_END && (status != Z_OK || (z.avail_in == 0 && z.avail_out > 0)))
            throw FormatError(0, "is compressed and damaged");
        out.resize(out.size() - z.avail_out);
    }
}

}  // namespace insonify::log::pocolog
