#include "components/pocolog/Reader.hpp"

#include <algorithm>

#include "components/pocolog/Inflate.hpp"
#include "components/pocolog/Scan.hpp"

namespace insonify::pocolog {
Reader::Reader(std::filesystem::path path, AtDamage at_damage)
    : path_(std::move(path)), file_(std::make_unique<BlockFile>(path_)) {
    Scan found = scan(*file_, path_, at_damage);
    streams_ = std::move(found.streams);
    samples_ = std::move(found.samples);
    gaps_ = std::move(found.gaps);
}

Reader::Reader(std::filesystem::path path, std::unique_ptr<Source> source)
    : path_(std::move(path)),
      source_(std::move(source)),
      streams_(std::move(source_->streams)),
      samples_(std::move(source_->samples)),
      gaps_(std::move(source_->gaps)) {}

Reader::~Reader() = default;

uint64_t Reader::bytes() const { return source_ ? source_->bytes : file_->size(); }

std::string Reader::fault() const {
    return gaps_.empty() ? "" : gaps_.front().what + " at byte " + std::to_string(gaps_.front().from);
}

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

std::span<const char> Reader::bytesOf(const SampleRef& at) {
    if (source_) try {
            source_->read(at, buffer_);
            return buffer_;
        } catch (const std::runtime_error& error) {
            failSample(at, error.what());
        }
    buffer_.resize(at.size);
    if (!file_->read(at.position, buffer_.data(), at.size)) failSample(at, "cannot be read any more");
    if (!at.compressed) return buffer_;
    try {
        inflateTo(inflated_, buffer_);
    } catch (const WireError& error) {
        failSample(at, error.what());
    }
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
