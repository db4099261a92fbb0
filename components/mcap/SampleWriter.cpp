#include "components/mcap/SampleWriter.hpp"

#include <algorithm>
#include <cctype>

namespace insonify::mcap {
namespace {

/** "/task/port" of "task.port", of letters, digits and underscores, as ROS has its names. */
std::string topicOf(const std::string& stream) {
    std::string topic = "/" + stream;
    for (char& c : topic)
        if (c == '.')
            c = '/';
        else if (c != '/' && !std::isalnum(static_cast<unsigned char>(c)))
            c = '_';
    return topic;
}

uint64_t nanoseconds(types::Time time) { return static_cast<uint64_t>(std::max<int64_t>(time.microseconds, 0)) * 1000; }

template <class E>
std::string nameOf(E value) {
    return std::string(types::EnumNames<E>::names[static_cast<size_t>(value)]);
}

}  // namespace

SampleWriter::SampleWriter(std::filesystem::path path, const McapConfig& config)
    : config_(config), bag_(path), out_(std::move(path)) {
    bag_.write(out_);
}

SampleWriter::~SampleWriter() {
    try {
        close();
    } catch (const std::exception&) {
        // A destructor has nobody to tell; close() does.
    }
}

size_t SampleWriter::declare(const std::string& name, const std::string& type, Schema schema, const char* hash,
                             const pocolog::Metadata& metadata) {
    if (metadata_ != metadata) out_.addMetadata("insonify", metadata_ = metadata);
    auto known = schemas_.find(schema.name);
    if (known == schemas_.end()) {
        const std::string message = schema.name;
        known = schemas_.emplace(message, out_.addSchema(std::move(schema))).first;
    }
    Texts texts = {{"offered_qos_profiles", qos_profile},
                   {"topic_type_hash", hash},
                   {"insonify_stream", name},
                   {"insonify_type", type},
                   {"insonify_order", nameOf(config_.order)},
                   {"insonify_frame", nameOf(config_.frame)},
                   {"insonify_world_frame", nameOf(config_.world_frame)}};
    return out_.addChannel({known->second, topicOf(name), "cdr", std::move(texts)});
}

void SampleWriter::put(size_t stream, types::Time received, types::Time time) {
    out_.write(static_cast<uint16_t>(stream), nanoseconds(received), nanoseconds(time), bytes_);
}

void SampleWriter::fail(size_t stream, const std::string& why) const {
    throw std::runtime_error(path().string() + ": a sample of " +
                             out_.channels()[stream].metadata.at("insonify_stream") +
                             " cannot be written as a message: " + why);
}

void SampleWriter::close() {
    if (std::exchange(closed_, true)) return;
    out_.close();
    bag_.write(out_);
}

void SampleWriter::next(std::filesystem::path path) {
    out_.close();
    bag_.add(out_.summary());
    out_.next(std::move(path));
    bag_.write(out_);
}

}  // namespace insonify::mcap
