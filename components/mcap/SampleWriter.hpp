#pragma once
#include <map>
#include <memory>

#include "components/mcap/Bag.hpp"
#include "components/mcap/Conversions.hpp"
#include "components/mcap/Writer.hpp"
#include "components/pocolog/Metadata.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/Schema.hpp"

namespace insonify::mcap {

/** Writes samples into an MCAP file as ROS 2 messages, with metadata.yaml beside it for `ros2 bag`.
 *
 *  Stream "task.port" is topic /task/port. Metadata of the streams go into records named "insonify", each time they
 *  change. Log time is when a sample was received, publish time when it was true. As pocolog::Writer otherwise. */
class SampleWriter {
public:
    /** Throws ConfigError when the file cannot be created, or the folder holds the metadata.yaml of another bag. */
    SampleWriter(std::filesystem::path path, const McapConfig& config);
    ~SampleWriter();  ///< Closes; trouble at that point is not reported.

    template <class T>
    size_t addStream(const std::string& name, const pocolog::Metadata& metadata) {
        using Message = typename Conversion<T>::Message;
        using Sample = typename Conversion<T>::Sample;
        return declare(name, pocolog::cxxName<Sample>(), {Message::type_name, "ros2msg", ros::schemaOf<Message>()},
                       Message::type_hash, metadata);
    }

    /** Throws std::runtime_error for a sample that cannot be told as a message: a compressed picture, a time after
     *  2038. */
    template <class T>
    void write(size_t stream, types::Time received, const T& sample) {
        auto& message = std::get<typename Conversion<T>::Message>(messages_);
        bytes_.clear();
        try {
            Conversion<T>::toMessage(sample, config_, message);
            ros::encode(message, bytes_);
        } catch (const std::logic_error& error) {
            fail(stream, error.what());
        }
        put(stream, received, pocolog::sampleTime(sample, received));
    }

    void flush() { out_.flush(); }
    void close();
    void next(std::filesystem::path path);

    const std::filesystem::path& path() const { return out_.path(); }
    uint64_t size() const { return out_.size(); }  ///< [B]
    uint64_t kept() const { return out_.kept(); }  ///< Samples in all files [1].

private:
    size_t declare(const std::string& name, const std::string& type, Schema schema, const char* hash,
                   const pocolog::Metadata& metadata);
    [[noreturn]] void fail(size_t stream, const std::string& why) const;
    void put(size_t stream, types::Time received, types::Time time);

    McapConfig config_;
    Bag bag_;
    Writer out_;
    bool closed_ = false;
    std::map<std::string, uint16_t> schemas_;
    pocolog::Metadata metadata_;  ///< As last written.
    ros::MessageTypes messages_;  ///< Room to convert into.
    std::vector<char> bytes_;
};

}  // namespace insonify::mcap
