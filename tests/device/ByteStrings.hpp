#pragma once
#include <string>

#include "components/device/wire/Bytes.hpp"

namespace insonify::device {

inline Bytes toBytes(const std::string& text) { return {text.begin(), text.end()}; }

inline Bytes operator+(Bytes a, const Bytes& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

}  // namespace insonify::device
