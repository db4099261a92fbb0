#pragma once
// Rock's names of samples' types, in logs of either format.
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "types/text/Describe.hpp"

namespace insonify::log {

template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};
template <class T>
concept Vector = IsVector<T>::value;
template <class T>
concept Numeric = std::is_arithmetic_v<T>;
template <class T>
concept Text = std::is_same_v<T, std::string>;
/** Eigen types, opaque in Rock: they are sent as /wrappers/Matrix and /wrappers/Quaternion. */
template <class T>
concept Matrix = std::is_same_v<T, glm::dvec3> || std::is_same_v<T, glm::dvec4> || std::is_same_v<T, glm::dmat3>;
template <class T>
concept Quaternion = std::is_same_v<T, glm::dquat>;

/** Calls `visit(field, value)` for each field of a value-initialised T. */
template <types::Described T, class V>
void forEachField(V&& visit) {
    T value{};
    T::describe(value, visit);
}

/** Whether T has opaque (Eigen) fields in Rock, so that its logged type is another one, named `..._m`. */
template <class T>
bool hasOpaque() {
    if constexpr (Vector<T>)
        return hasOpaque<typename T::value_type>();
    else if constexpr (types::Described<T>) {
        bool found = false;
        forEachField<T>([&]<class F>(const types::Field&, F&) { found = found || hasOpaque<F>(); });
        return found;
    } else
        return Matrix<T> || Quaternion<T>;
}

template <Numeric T>
std::string numericName() {
    if constexpr (std::is_same_v<T, bool>)
        return "/bool";
    else if constexpr (std::is_same_v<T, double>)
        return "/double";
    else if constexpr (std::is_same_v<T, float>)
        return "/float";
    else
        return (std::is_signed_v<T> ? "/int" : "/uint") + std::to_string(8 * sizeof(T)) + "_t";
}

/** Returns the name of T in logs: "/base/samples/RigidBodyState_m", "/std/vector</float>". */
template <class T>
std::string typelibName() {
    if constexpr (Numeric<T>)
        return numericName<T>();
    else if constexpr (Text<T>)
        return "/std/string";
    else if constexpr (Vector<T>)
        return "/std/vector<" + typelibName<typename T::value_type>() + ">";
    else if constexpr (std::is_same_v<T, glm::dvec3>)
        return "/wrappers/Matrix</double,3,1>";
    else if constexpr (std::is_same_v<T, glm::dvec4>)
        return "/wrappers/Matrix</double,4,1>";
    else if constexpr (std::is_same_v<T, glm::dmat3>)
        return "/wrappers/Matrix</double,3,3>";
    else if constexpr (Quaternion<T>)
        return "/wrappers/Quaternion</double>";
    else if constexpr (std::is_enum_v<T>)
        return types::EnumTable<T>::name;
    else
        return std::string(T::type_name) + (hasOpaque<T>() ? "_m" : "");
}

/** Returns the name of T in Rock's C++, without the suffix of opaques. */
template <class T>
std::string cxxName() {
    if constexpr (types::Described<T>)
        return T::type_name;
    else
        return typelibName<T>();
}

}  // namespace insonify::log
