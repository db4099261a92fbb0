#include "components/pocolog/Scan.hpp"

#include <algorithm>
#include <map>

namespace insonify::pocolog {
namespace {

class Scanner {
public:
    Scanner(const BlockFile& file, Scan& result) : file_(file), result_(result) {}

    /** Takes whole blocks until the file ends; what is none is passed over or ends the pass. */
    void run(AtDamage at_damage) {
        for (uint64_t position = sizeof(Prologue); position < file_.size();) try {
                position = take(position);
            } catch (const Fault& fault) {
                const bool skips = at_damage == AtDamage::Skip;
                const uint64_t next = skips ? nextBlock(position + 1) : file_.size();
                addGap({position, next, fault.byte, fault.what()});
                position = next;
            }
    }

private:
    /** Takes a block and returns where the next one begins. */
    uint64_t take(uint64_t block) {
        const BlockHeader header = file_.header(block);
        if (header.type == BlockType::Stream && !index_.contains(header.stream)) {  // repeated ones are harmless
            Declaration declaration = file_.declaration(block, header);
            index_[header.stream] = result_.streams.size();
            result_.streams.push_back(std::move(declaration.stream));
        }
        if (header.type == BlockType::Data) sample(block, header);
        return block + sizeof header + header.size;
    }

    void sample(uint64_t block, const BlockHeader& header) {
        const auto stream = index_.find(header.stream);
        if (stream == index_.end())
            throw Fault(block + offsetof(BlockHeader, stream),
                        "a sample of a stream that is not declared: " + std::to_string(header.stream));
        const DataHeader data = file_.data(block, header);
        const uint64_t position = block + sizeof header + data_header_size;
        result_.samples.push_back(
            {stream->second, data.received(), data.time(), position, data.size, data.compressed != 0});
        count(result_.streams[stream->second], data.time());
    }

    static void count(Stream& stream, types::Time time) {
        if (stream.count++ == 0) stream.first = time;
        stream.last = time;
    }

    void addGap(Gap gap) {
        auto& gaps = result_.gaps;
        if (!gaps.empty() && gaps.back().to == gap.from)
            gaps.back().to = gap.to;
        else
            gaps.push_back(std::move(gap));
    }

    /** The first place from `position` on at which a block seems to stand, or the end of the file. */
    uint64_t nextBlock(uint64_t position) const {
        std::vector<char> window(1 << 20);
        for (; position + sizeof(BlockHeader) <= file_.size(); position += window.size()) {
            const size_t size = std::min<uint64_t>(window.size(), file_.size() - position);
            if (!file_.read(position, window.data(), size)) break;
            for (size_t i = 0; i < size; ++i)
                if ((window[i] == 1 || window[i] == 2) && looksLikeBlock(position + i)) return position + i;
        }
        return file_.size();
    }

    /** A format without marks gives no certainty: sizes that agree twice, and a block or the end behind it. */
    bool looksLikeBlock(uint64_t block) const try {
        const BlockHeader header = file_.header(block);
        if (header.type == BlockType::Stream)
            file_.declaration(block, header);
        else if (!index_.contains(header.stream) || !hasMicroseconds(file_.data(block, header)))
            return false;
        const uint64_t next = block + sizeof header + header.size;
        uint8_t type = 0;
        return !file_.read(next, &type, sizeof type) || (type >= 1 && type <= 3);
    } catch (const Fault&) {
        return false;
    }

    static bool hasMicroseconds(const DataHeader& data) {
        return data.received_us < 1'000'000 && data.time_us < 1'000'000 && data.compressed <= 1;
    }

    const BlockFile& file_;
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

Scan scan(const BlockFile& file, const std::filesystem::path& path, AtDamage at_damage) {
    Scan result;
    Prologue prologue;
    const size_t there = std::min<size_t>(file.size(), sizeof prologue);
    if (there < magic.size() || !file.read(0, &prologue, there))
        throw types::ConfigError(path, "", "is not a pocolog file: it is too short");
    try {
        checkPrologue(prologue, path);
    } catch (const types::ConfigError& error) {
        if (at_damage == AtDamage::Stop) throw;
        result.gaps.push_back({0, there, 0, "the prologue " + error.diagnostics().front().message});
    }
    if (there < sizeof prologue)
        result.gaps.push_back({0, there, there, "the file ends within its prologue"});
    else
        Scanner(file, result).run(at_damage);
    return result;
}

}  // namespace insonify::pocolog
