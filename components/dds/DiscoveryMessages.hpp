#pragma once
// The messages by which ROS 2 nodes announce themselves: rmw_dds_common, field for field. See ros/GeometryMessages.hpp.
#include <array>
#include <string>
#include <vector>

#include "types/Describe.hpp"

namespace insonify::dds {

/** Identifier of 16 bytes since ROS 2 Iron, 24 in Humble and before. */
template <size_t size>
struct Gid {
    static constexpr const char* type_name = "rmw_dds_common/msg/Gid";
    static constexpr const char* type_hash = "";
    std::array<uint8_t, size> data{};

    friend bool operator==(const Gid&, const Gid&) = default;
    static void describe(auto& self, auto& visit) { visit({"data"}, self.data); }
};

template <size_t gid_size>
struct NodeEntitiesInfo {
    static constexpr const char* type_name = "rmw_dds_common/msg/NodeEntitiesInfo";
    static constexpr const char* type_hash = "";
    std::string node_namespace, node_name;
    std::vector<Gid<gid_size>> reader_gid_seq, writer_gid_seq;

    friend bool operator==(const NodeEntitiesInfo&, const NodeEntitiesInfo&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"node_namespace"}, self.node_namespace);
        visit({"node_name"}, self.node_name);
        visit({"reader_gid_seq"}, self.reader_gid_seq);
        visit({"writer_gid_seq"}, self.writer_gid_seq);
    }
};

template <size_t gid_size>
struct ParticipantEntitiesInfo {
    static constexpr const char* type_name = "rmw_dds_common/msg/ParticipantEntitiesInfo";
    static constexpr const char* type_hash =
        gid_size == 16 ? "RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e" : "";
    Gid<gid_size> gid;
    std::vector<NodeEntitiesInfo<gid_size>> node_entities_info_seq;

    friend bool operator==(const ParticipantEntitiesInfo&, const ParticipantEntitiesInfo&) = default;
    static void describe(auto& self, auto& visit) {
        visit({"gid"}, self.gid);
        visit({"node_entities_info_seq"}, self.node_entities_info_seq);
    }
};

}  // namespace insonify::dds
