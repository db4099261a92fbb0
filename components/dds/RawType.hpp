#pragma once
#include <limits>
#include <string>
#include <vector>

struct ddsi_sertype;

namespace insonify::dds {

/** A sample as Cyclone is given it and gives it back: the bytes of one message, encapsulation first. */
using Bytes = std::vector<char>;

inline constexpr size_t any_size = std::numeric_limits<size_t>::max();

/** A type of that DDS name whose samples are Bytes, for dds_create_topic_sertype.
 *
 *  It has no key and tells the network nothing of its members, so peers match it by its name alone, as ROS 2 does: a
 *  peer of a newer Cyclone that asks an 0.10 process for the members crashes it. Bytes that come from the network are
 *  handed on as they are, but for messages of more than `largest` bytes, which are empty then; who takes them checks
 *  them. */
ddsi_sertype* makeRawType(const std::string& type_name, size_t largest = any_size);

}  // namespace insonify::dds
