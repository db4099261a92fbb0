#include "components/log/pocolog/Writer.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "components/log/TypeNames.hpp"
#include "components/log/pocolog/Reader.hpp"
#include "components/log/pocolog/Wire.hpp"
#include "types/Check.hpp"
#include "types/Time.hpp"

namespace insonify::log::pocolog {
namespace {

constexpr size_t flush_size = 1 << 20;  // [B]

/** Returns the time within the format's range. A time before that of the sample before is set to it, unless the clock
 *  was set back. */
types::Time logTime(types::Time time, types::Time before) {
    time = std::clamp(time, types::Time{}, latest_time);
    return before - time > types::max_lateness ? time : std::max(time, before);
}

void split(types::Time time, uint32_t& s, uint32_t& us) {
    s = static_cast<uint32_t>(time.microseconds / 1'000'000);
    us = static_cast<uint32_t>(time.microseconds % 1'000'000);
}

}  // namespace

Writer::Writer(std::filesystem::path path) : path_(std::move(path)) { open(); }

void Writer::open() {
    file_.emplace(path_);
    flushed_ = 0;
    Prologue prologue;
    std::copy(magic.begin(), magic.end(), prologue.magic_bytes.begin());
    append(&prologue, sizeof prologue);
    for (Written& stream : streams_) stream.index = {.declaration = size() + stream.declaration};
    append(declarations_.data(), declarations_.size());
}

Writer::~Writer() {
    if (flushed_ == 0 && taken_ == 0) return;
    try {
        close();
    } catch (const std::exception&) {
        // A destructor cannot report errors; flush() and close() do.
    }
}

Metadata Writer::standardMetadata(const std::string& name, const std::string& cxx_type) {
    const size_t dot = std::min(name.find('.'), name.size());
    return {{"rock_task_name", name.substr(0, dot)},
            {"rock_task_object_name", name.substr(std::min(dot + 1, name.size()))},
            {"rock_stream_type", "port"},
            {"rock_cxx_type_name", cxx_type},
            {"rock_orocos_type_name", cxx_type}};
}

size_t Writer::add(size_t sample, const std::string& name, const Metadata& metadata) {
    size_t number = 0;
    types::forEachSampleType([&]<class T>(std::type_identity<T>) {
        if (types::sampleIndex<T>() != sample) return;
        Metadata all = metadata;
        if constexpr (types::Stamped<T>) all.emplace("rock_timestamp_field", "time");
        all.merge(standardMetadata(name, cxxName<T>()));
        number = declare(name, typelibName<T>(), makeRegistry<T>(), all);
    });
    return number;
}

size_t Writer::declare(const std::string& name, const std::string& type, const std::string& registry,
                       const Metadata& metadata) {
    return declareRaw(name, type, registry, toYaml(metadata));
}

size_t Writer::declareRaw(const std::string& name, const std::string& type, const std::string& registry,
                          const std::string& yaml) {
    if (streams_.size() > std::numeric_limits<uint16_t>::max())
        throw std::length_error(path_.string() + ": a log holds at most 65536 streams");
    const uint8_t data_stream = 1;
    const size_t size =
        sizeof data_stream + 4 * sizeof(uint32_t) + name.size() + type.size() + registry.size() + yaml.size();
    Written& stream = streams_.emplace_back();
    stream.declaration = declarations_.size();
    stream.index.declaration = this->size();
    Encoder block(declarations_);
    block.scalar(BlockHeader{.type = BlockType::Stream,
                             .stream = static_cast<uint16_t>(streams_.size() - 1),
                             .size = static_cast<uint32_t>(size)});
    block.scalar(data_stream);
    for (const std::string* text : {&name, &type, &registry, &yaml}) {
        block.scalar(static_cast<uint32_t>(text->size()));
        block.bytes(text->data(), text->size());
    }
    INSONIFY_CHECK(declarations_.size() - stream.declaration == sizeof(BlockHeader) + size, declarations_.size(),
                   stream.declaration, size);
    append(declarations_.data() + stream.declaration, declarations_.size() - stream.declaration);
    return streams_.size() - 1;
}

void Writer::write(size_t stream, types::Time received, types::Time time, std::span<const char> bytes) {
    const size_t start = beginSample();
    append(bytes.data(), bytes.size());
    endSample(stream, start, received, time);
}

void Writer::put(size_t stream, types::Time received, types::Time time, types::SampleView sample) {
    const size_t start = beginSample();
    std::visit(
        [&](const auto* held) {
            marshal(*held, buffer_);
            endSample(stream, start, received, sampleTime(*held, time));
        },
        sample);
}

size_t Writer::addLike(const log::Reader& log, size_t number, const Metadata& more) {
    const Stream& stream = log.streams()[number];
    Metadata all = stream.metadata;
    all.insert(more.begin(), more.end());
    const bool unchanged = all.size() == stream.metadata.size();
    if (const auto* same = dynamic_cast<const Reader*>(&log))
        return declareRaw(stream.name, stream.type, same->layout(number),
                          unchanged && !findNotFlat(same->yaml(number)) ? same->yaml(number) : toYaml(all));
    if (!stream.sample)
        throw types::ConfigError(log.path(), stream.name, "holds " + stream.type + ", which pocolog cannot hold");
    return add(*stream.sample, stream.name, all);
}

void Writer::copy(size_t number, log::Reader& log, const SampleRef& at) {
    if (dynamic_cast<const Reader*>(&log)) return write(number, at.received, at.time, log.toBytes(at));
    put(number, at.received, at.time, log.sampleAt(at));
}

size_t Writer::beginSample() {
    if (!isOpen()) throw std::runtime_error(path_.string() + ": the log is closed");
    const size_t start = buffer_.size();
    buffer_.resize(start + sizeof(BlockHeader) + data_header_size);
    return start;
}

void Writer::endSample(size_t number, size_t start, types::Time received, types::Time time) {
    INSONIFY_CHECK(buffer_.size() >= start + sizeof(BlockHeader) + data_header_size, buffer_.size(), start);
    const size_t size = buffer_.size() - start - sizeof(BlockHeader);
    if (size > std::numeric_limits<uint32_t>::max()) {
        buffer_.resize(start);
        throw std::length_error(path_.string() + ": a sample on a log may not exceed 4 GiB");
    }
    Written& stream = streams_.at(number);
    received = logTime(received, stream.last_received);
    time = logTime(time, stream.last_time);
    BlockHeader block{
        .type = BlockType::Data, .stream = static_cast<uint16_t>(number), .size = static_cast<uint32_t>(size)};
    DataHeader data{.size = static_cast<uint32_t>(size - data_header_size)};
    split(received, data.received_s, data.received_us);
    split(time, data.time_s, data.time_us);
    std::memcpy(buffer_.data() + start, &block, sizeof block);
    std::memcpy(buffer_.data() + start + sizeof block, &data, data_header_size);

    if (stream.index.samples.empty()) stream.index.first_received = received;
    stream.index.last_received = stream.last_received = received;
    stream.last_time = time;
    stream.index.samples.push_back({flushed_ + start, time});
    ++taken_;
    ++unflushed_;
    if (buffer_.size() >= flush_size) flush();
}

void Writer::append(const void* data, size_t size) {
    const char* first = static_cast<const char*>(data);
    buffer_.insert(buffer_.end(), first, first + size);
}

void Writer::flush() {
    if (!isOpen()) return;
    std::error_code none_there;
    if (flushed_ == 0) std::filesystem::remove(indexPath(path_), none_there);  // of the file that is replaced
    file_->append(buffer_.data(), buffer_.size());
    flushed_ = file_->size();
    unflushed_ = 0;
    buffer_.clear();
}

void Writer::sync() {
    flush();
    if (isOpen()) file_->sync();
}

void Writer::close() {
    if (!isOpen()) return;
    flush();
    file_->close();
    std::vector<StreamIndex> index;
    for (Written& stream : streams_) index.push_back(std::move(stream.index));
    writeIndex(path_, index);
}

void Writer::next(std::filesystem::path path) {
    close();
    taken_ -= std::exchange(unflushed_, 0);
    buffer_.clear();
    path_ = std::move(path);
    open();
}

}  // namespace insonify::log::pocolog
