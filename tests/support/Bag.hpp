#pragma once
// Bags as other programs record them: messages of any type, in MCAP or in the SQLite database of rosbag2.
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "components/log/mcap/ChunkWriter.hpp"
#include "components/ros/Cdr.hpp"
#include "components/ros/Samples.hpp"
#include "components/ros/Schema.hpp"
#include "tests/support/Folder.hpp"
#include "tests/support/Python.hpp"
#include "types/Time.hpp"

namespace insonify::test {

/** Messages in the order of their reception. */
class Bag {
public:
    /** @param received when it was received, which need not be its stamp */
    template <class Message>
    void add(const std::string& topic, types::Time received, const Message& message) {
        types_[topic] = {Message::type_name, ros::describeSchema<Message>()};
        order_.push_back({topic, received.microseconds * 1000, {}});
        ros::encode(message, order_.back().bytes);
    }
    /** Damages a message: it keeps only its first bytes. */
    void cut(size_t number, size_t bytes) { order_.at(number).bytes.resize(bytes); }
    void writeMcap(const std::filesystem::path& path) const {
        log::mcap::ChunkWriter out(path);
        std::map<std::string, uint16_t> channels;
        for (const auto& [topic, type] : types_)
            channels[topic] = out.addChannel({out.addSchema({type.name, "ros2msg", type.schema}), topic, "cdr", {}});
        for (const Entry& entry : order_) {
            const auto ns = static_cast<uint64_t>(entry.ns);
            out.write(channels[entry.topic], ns, ns, entry.bytes);
        }
        out.close();
    }
    /** Writes by Python's sqlite3; more arguments go to write_db3.py. Returns what it printed: nothing. */
    std::string writeDb3(const std::filesystem::path& path, const std::string& arguments = "") const {
        const std::filesystem::path list = path.string() + ".txt";
        {
            std::ofstream out(list);
            for (const Entry& entry : order_) {
                out << entry.topic << ' ' << types_.at(entry.topic).name << ' ' << entry.ns << ' ';
                for (const char c : entry.bytes) {
                    const auto byte = static_cast<unsigned char>(c);
                    out << "0123456789abcdef"[byte / 16] << "0123456789abcdef"[byte % 16];
                }
                out << '\n';
            }
        }
        const std::string says = pythonSays(
            sourceFile("tests/support/write_db3.py") + " '" + list.string() + "' '" + path.string() + "' " + arguments,
            path.parent_path() / "answer");
        std::filesystem::remove(list);
        std::filesystem::remove(path.parent_path() / "answer");
        return says;
    }

private:
    struct Type {
        std::string name, schema;
    };
    struct Entry {
        std::string topic;
        int64_t ns = 0;
        std::vector<char> bytes;
    };
    std::map<std::string, Type> types_;
    std::vector<Entry> order_;
};

}  // namespace insonify::test
