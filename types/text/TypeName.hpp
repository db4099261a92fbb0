#pragma once
#include <memory>
#include <string>

namespace insonify::types {

template <class T>
struct Pointee {
    using type = T;
};
template <class T>
struct Pointee<std::shared_ptr<const T>> {
    using type = T;
};

/** Types that count the progress of runs (`counted`), passed by value or by shared pointer. */
template <class T>
concept Counted = requires {
    requires Pointee<T>::type::counted;
};

/** Returns the name of a type on a port; a shared pointer has the name of its sample: "/base/samples/Sonar". */
template <class T>
std::string typeName() {
    using Value = typename Pointee<T>::type;
    if constexpr (requires { Value::type_name; })
        return Value::type_name;
    else if constexpr (std::is_same_v<Value, double>)
        return "/double";
    else if constexpr (std::is_same_v<Value, float>)
        return "/float";
    else if constexpr (std::is_same_v<Value, int32_t>)
        return "/int32_t";
    else if constexpr (std::is_same_v<Value, int64_t>)
        return "/int64_t";
    else if constexpr (std::is_same_v<Value, bool>)
        return "/bool";
    else
        return "/std/string";
}

}  // namespace insonify::types
