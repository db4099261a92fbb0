#pragma once
#include <array>
#include <type_traits>
#include <vector>

#include "types/Describe.hpp"

namespace insonify::ros {

template <class T>
concept Message = types::Described<T> && requires {
    T::type_hash;
};

/** Whether T is a sequence or an array of fixed length in ROS. */
template <class T>
struct IsSequence : std::false_type {};
template <class T>
struct IsSequence<std::vector<T>> : std::true_type {};
template <class T>
struct IsArray : std::false_type {};
template <class T, size_t n>
struct IsArray<std::array<T, n>> : std::true_type {};

template <class T>
concept Sequence = IsSequence<T>::value;
template <class T>
concept Array = IsArray<T>::value;
template <class T>
concept Primitive = std::is_arithmetic_v<T>;

}  // namespace insonify::ros
