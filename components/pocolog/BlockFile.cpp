#include "components/pocolog/BlockFile.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace insonify::pocolog {
namespace {

/** Takes a text of a declaration and returns its position. */
uint64_t takeText(Decoder& decoder, uint64_t payload, const char* what, std::string& text) {
    const uint64_t count_at = payload + decoder.taken();
    uint32_t size = 0;
    if (decoder.left() < sizeof size)
        throw Fault(count_at, fmt::format("the declaration of a stream is damaged: it ends before its {}", what));
    decoder.scalar(size);
    if (size > decoder.left())
        throw Fault(count_at, fmt::format("the declaration of a stream is damaged: its {} has {} bytes, {} are left",
                                          what, size, decoder.left()));
    text.resize(size);
    decoder.bytes(text.data(), size);
    return count_at + sizeof size;
}

}  // namespace

BlockFile::BlockFile(const std::filesystem::path& path) {
    file_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file_ < 0) throw types::ConfigError(path, "", "cannot be read: " + std::generic_category().message(errno));
    struct stat status {};
    if (fstat(file_, &status) != 0 || !S_ISREG(status.st_mode)) {
        ::close(file_);
        throw types::ConfigError(path, "", "is not a file");
    }
    size_ = static_cast<uint64_t>(status.st_size);
}

BlockFile::~BlockFile() { ::close(file_); }

bool BlockFile::read(uint64_t position, void* to, size_t size) const {
    char* next = static_cast<char*>(to);
    while (size > 0) {
        const ssize_t got = pread(file_, next, size, static_cast<off_t>(position));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        next += got;
        position += static_cast<uint64_t>(got);
        size -= static_cast<size_t>(got);
    }
    return true;
}

BlockHeader BlockFile::header(uint64_t block) const {
    BlockHeader header;
    if (!read(block, &header, sizeof header)) throw Fault(size_, "the file ends within the header of a block");
    if (header.type < BlockType::Stream || header.type > BlockType::Control)
        throw Fault(block, fmt::format("there is no block: its type is {}, it may be 1 (a stream), 2 (a sample) or 3 "
                                       "(control)",
                                       static_cast<int>(header.type)));
    const uint64_t left = size_ - block - sizeof header;
    if (header.size > left)
        throw Fault(block + offsetof(BlockHeader, size),
                    fmt::format("the file ends within a block: it has {} bytes, {} are left", header.size, left));
    return header;
}

Declaration BlockFile::declaration(uint64_t block, const BlockHeader& header) const {
    const uint64_t payload = block + sizeof header;
    std::vector<char> bytes(header.size);
    if (!read(payload, bytes.data(), bytes.size())) throw Fault(payload, "the file cannot be read");
    if (bytes.empty() || bytes[0] != 1)
        throw Fault(payload, "the declaration of a stream is damaged: its kind may be 1 (of samples)");
    Decoder decoder(std::span<const char>(bytes).subspan(1));
    Declaration found;
    found.name_at = takeText(decoder, payload + 1, "name", found.stream.name);
    found.type_at = takeText(decoder, payload + 1, "type", found.stream.type);
    found.registry_at = takeText(decoder, payload + 1, "registry", found.stream.registry);
    found.yaml_at = takeText(decoder, payload + 1, "metadata", found.yaml);
    found.stream.metadata = metadataFromYaml(found.yaml);
    return found;
}

DataHeader BlockFile::data(uint64_t block, const BlockHeader& header) const {
    const uint64_t payload = block + sizeof header;
    DataHeader data;
    if (header.size < data_header_size || !read(payload, &data, data_header_size))
        throw Fault(block + offsetof(BlockHeader, size),
                    fmt::format("the sizes of a sample do not agree: its block has {} bytes, {} are its header",
                                header.size, data_header_size));
    if (data.size != header.size - data_header_size)
        throw Fault(payload + offsetof(DataHeader, size),
                    fmt::format("the sizes of a sample do not agree: it has {} bytes, its block leaves it {}",
                                data.size, header.size - data_header_size));
    return data;
}

}  // namespace insonify::pocolog
