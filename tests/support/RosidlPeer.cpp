// A program with ROS 2's generated code. For each message of insonify_msgs it prints the definition from type support,
// reads FOLDER/NAME.cdr into the generated struct, and writes the struct to FOLDER/NAME.again.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

#include "insonify_msgs/msg/detail/sonar_elements__rosidl_typesupport_introspection_cpp.hpp"
#include "insonify_msgs/msg/detail/sonar_returns__rosidl_typesupport_introspection_cpp.hpp"
#include "insonify_msgs/msg/detail/sonar_settings__rosidl_typesupport_introspection_cpp.hpp"
#include "insonify_msgs/msg/detail/sonar_truth__rosidl_typesupport_introspection_cpp.hpp"
#include "insonify_msgs/msg/sonar_elements.hpp"
#include "insonify_msgs/msg/sonar_returns.hpp"
#include "insonify_msgs/msg/sonar_settings.hpp"
#include "insonify_msgs/msg/sonar_truth.hpp"
#include "rosidl_typesupport_introspection_cpp/field_types.hpp"
#include "rosidl_typesupport_introspection_cpp/message_introspection.hpp"
#include "rosidl_typesupport_introspection_cpp/message_type_support_decl.hpp"

namespace types = rosidl_typesupport_introspection_cpp;

namespace {

struct Plain {
    uint8_t id;
    const char* name;
    size_t size;
};
constexpr Plain plain_types[] = {{types::ROS_TYPE_FLOAT, "float32", 4}, {types::ROS_TYPE_DOUBLE, "float64", 8},
                                 {types::ROS_TYPE_UINT8, "uint8", 1},   {types::ROS_TYPE_INT32, "int32", 4},
                                 {types::ROS_TYPE_UINT32, "uint32", 4}, {types::ROS_TYPE_INT64, "int64", 8}};

const Plain* findPlain(const types::MessageMember& member) {
    const auto* found = std::ranges::find(plain_types, member.type_id_, &Plain::id);
    return found == std::end(plain_types) ? nullptr : found;
}

const types::MessageMembers& getMembers(const rosidl_message_type_support_t* support) {
    return *static_cast<const types::MessageMembers*>(support->data);
}

/** Bytes of CDR after the four bytes of header, read or written: plain CDR of version 1, little endian. */
struct Cdr {
    std::string bytes;
    bool writing;
    size_t at = 0;

    void plain(void* value, size_t size) {
        at = (at + size - 1) / size * size;
        if (writing) bytes.resize(at + size);
        char* const here = &bytes.at(at + size - 1) + 1 - size;
        writing ? std::memcpy(here, value, size) : std::memcpy(value, here, size);
        at += size;
    }
    void text(std::string& value) {
        uint32_t size = static_cast<uint32_t>(value.size()) + 1;
        plain(&size, 4);
        if (!writing) value.resize(size - 1);
        for (char& c : value) plain(&c, 1);
        char end = 0;
        plain(&end, 1);
    }
    void one(const types::MessageMember& member, void* value) {
        if (member.type_id_ == types::ROS_TYPE_MESSAGE)
            message(getMembers(member.members_), value);
        else if (member.type_id_ == types::ROS_TYPE_STRING)
            text(*static_cast<std::string*>(value));
        else
            plain(value, findPlain(member)->size);
    }
    void message(const types::MessageMembers& members, void* value) {
        for (uint32_t i = 0; i < members.member_count_; ++i) {
            const types::MessageMember& member = members.members_[i];
            void* const field = static_cast<char*>(value) + member.offset_;
            if (!member.is_array_) {
                one(member, field);
                continue;
            }
            uint32_t size = static_cast<uint32_t>(member.size_function(field));
            plain(&size, 4);
            if (!writing) member.resize_function(field, size);
            for (uint32_t k = 0; k < size; ++k) one(member, member.get_function(field, k));
        }
    }
};

/** "std_msgs/Header" */
std::string getName(const types::MessageMembers& members) {
    const std::string space = members.message_namespace_;
    return space.substr(0, space.find("::")) + "/" + members.message_name_;
}

template <class Message>
void pass(const std::filesystem::path& folder, Message& message) {
    const auto& members = getMembers(types::get_message_type_support_handle<Message>());
    std::cout << getName(members) << '\n';
    for (uint32_t i = 0; i < members.member_count_; ++i) {
        const types::MessageMember& member = members.members_[i];
        const std::string type = member.type_id_ == types::ROS_TYPE_MESSAGE  ? getName(getMembers(member.members_))
                                 : member.type_id_ == types::ROS_TYPE_STRING ? "string"
                                                                             : findPlain(member)->name;
        const bool is_sequence = member.is_array_ && member.array_size_ == 0 && !member.is_upper_bound_;
        std::cout << type << (is_sequence ? "[]" : member.is_array_ ? "[?]" : "") << ' ' << member.name_ << '\n';
    }
    std::ifstream file(folder / (std::string(members.message_name_) + ".cdr"), std::ios::binary);
    const std::string all{std::istreambuf_iterator<char>(file), {}}, header = all.substr(0, 4);
    Cdr read{all.substr(4), false};
    read.message(members, &message);
    Cdr written{"", true};
    written.message(members, &message);
    std::ofstream(folder / (std::string(members.message_name_) + ".again"), std::ios::binary)
        << header << written.bytes;
}

}  // namespace

int main(int, char** arguments) {
    insonify_msgs::msg::SonarTruth truth;
    insonify_msgs::msg::SonarReturns returns;
    insonify_msgs::msg::SonarElements elements;
    insonify_msgs::msg::SonarSettings settings;
    pass(arguments[1], truth);
    pass(arguments[1], returns);
    pass(arguments[1], elements);
    pass(arguments[1], settings);
    std::cout << truth.header.stamp.sec << ' ' << truth.header.frame_id << ' ' << truth.objects.at(1) << ' '
              << truth.share.at(2) << ' ' << returns.bearings.at(1) << ' ' << elements.quadrature.at(1) << ' '
              << settings.range << ' ' << settings.beam_count << '\n';
}
