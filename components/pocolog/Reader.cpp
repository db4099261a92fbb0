#include "components/pocolog/Reader.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "components/pocolog/Scan.hpp"

namespace insonify::pocolog {
namespace {

struct Inflation {
    z_stream stream{};
    Inflation() {
        if (inflateInit(&stream) != Z_OK) throw std::runtime_error("cannot be decompressed: no memory");
    }
    ~Inflation() { inflateEnd(&stream); }
};

/** Decompresses a zlib stream; throws std::runtime_error when it is damaged or grows beyond 4 GiB. */
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
            throw std::runtime_error("is compressed and damaged");
        out.resize(out.size() - z.avail_out);
    }
}

}  // namespace

Reader::Reader(std::filesystem::path path) : path_(std::move(path)) {
    file_ = open(path_.c_str(), O_RDONLY | O_CLOEXEC);
    if (file_ < 0) throw types::ConfigError(path_, "", "cannot be read: " + std::generic_category().message(errno));
    try {
        Scan found = scan(file_, path_);
        bytes_ = found.bytes;
        fault_ = std::move(found.fault);
        streams_ = std::move(found.streams);
        samples_ = std::move(found.samples);
    } catch (...) {
        ::close(file_);
        throw;
    }
}

Reader::~Reader() { ::close(file_); }

const Stream* Reader::find(const std::string& name) const {
    const auto found = std::find_if(streams_.begin(), streams_.end(), [&](const Stream& s) { return s.name == name; });
    return found == streams_.end() ? nullptr : &*found;
}

size_t Reader::indexOf(const std::string& name) const {
    if (const Stream* stream = find(name)) return static_cast<size_t>(stream - streams_.data());
    std::string names;
    for (const Stream& stream : streams_) names += (names.empty() ? "" : ", ") + stream.name;
    throw types::ConfigError(path_, name, "there is no such stream; there are: " + (names.empty() ? "none" : names));
}

std::span<const char> Reader::payload(const SampleRef& at) {
    buffer_.resize(at.size);
    if (!readAt(file_, at.position, buffer_.data(), at.size)) throw std::runtime_error("cannot be read any more");
    if (!at.compressed) return buffer_;
    inflateTo(inflated_, buffer_);
    return inflated_;
}

void Reader::failSample(const SampleRef& at, const std::string& what) const {
    throw types::ConfigError(path_, streams_[at.stream].name,
                             "the sample at byte " + std::to_string(at.position) + " " + what);
}

void Reader::failType(const SampleRef& at, const std::string& wanted) const {
    const Stream& stream = streams_[at.stream];
    throw types::ConfigError(path_, stream.name, "holds " + stream.type + ", not " + wanted);
}

}  // namespace insonify::pocolog
