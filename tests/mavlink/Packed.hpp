#pragma once
// Frames of system 1, component 1, number 7, as PyPI's pymavlink 2.4.50 packs them.
#include <string>
#include <vector>

#include "components/mavlink/Frame.hpp"

namespace insonify::mavlink {

inline Bytes bytesOfHex(const std::string& hex) {
    Bytes bytes;
    for (size_t i = 0; i + 1 < hex.size(); i += 2)
        bytes.push_back(static_cast<uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
    return bytes;
}

inline Bytes joined(const std::vector<Bytes>& parts) {
    Bytes all;
    for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

/** ATTITUDE_QUATERNION at 123456 ms: 0.5, 0.5, -0.5, 0.5, rates 0.25, -0.5, 1; by each version, and signed. */
inline const Bytes attitude_1 =
    bytesOfHex("fe200701011f40e201000000003f0000003f000000bf0000003f0000803e000000bf0000803f502d");
inline const Bytes attitude_2 =
    bytesOfHex("fd2000000701011f000040e201000000003f0000003f000000bf0000003f0000803e000000bf0000803ffea8");
inline const Bytes attitude_signed = bytesOfHex(
    "fd2001000701011f000040e201000000003f0000003f000000bf0000003f0000803e000000bf0000803f2936014e61bc0000008a107cbed9"
    "9f");
/** LOCAL_POSITION_NED at 123456 ms: 1.5, -2.5, 3.5, and 0.5 to the north. */
inline const Bytes position_2 = bytesOfHex("fd14000007010120000040e201000000c03f000020c0000060400000003f739c");
/** VISION_POSITION_ESTIMATE at 1700000000123456 us: the same place, angles 0.125, 0.25, 0.5. */
inline const Bytes vision_2 =
    bytesOfHex("fd20000007010166000040222018240a06000000c03f000020c0000060400000003e0000803e0000003f4fad");
inline const Bytes heartbeat_2 = bytesOfHex("fd090000070101000000000000000c035104030695");
/** ATTITUDE, which is not read. */
inline const Bytes attitude_euler_2 =
    bytesOfHex("fd1c00000701011e000040e201000000003f0000003f000000bf0000003f0000803e000000bfa539");

}  // namespace insonify::mavlink
