#pragma once
#include <limits>
#include <string>
#include <vector>

struct ddsi_sertype;

namespace insonify::dds {

/** A sample for Cyclone DDS: the bytes of one message, beginning with the encapsulation. */
using Bytes = std::vector<char>;

inline constexpr size_t any_size = std::numeric_limits<size_t>::max();

/** Returns a type with the given DDS name whose samples are Bytes, for dds_create_topic_sertype.
 *
 *  It has no key and does not announce its members, so peers match it by name alone, as in ROS 2. Otherwise a peer of a
 *  newer Cyclone that asks a process with 0.10 for the members crashes it. Bytes from the network are passed on
 *  unchecked; the receiver checks them. Messages of more than `largest` bytes are passed on empty. */
ddsi_sertype* makeRawType(const std::string& type_name, size_t maximum = any_size);

}  // namespace insonify::dds
