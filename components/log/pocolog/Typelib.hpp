#pragma once
// Size, alignment on x86-64 and XML registry of a described C++ type, as in Rock's typelib.
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "components/log/TypeNames.hpp"
#include "types/Time.hpp"
#include "types/samples/Image.hpp"

namespace insonify::log::pocolog {

/** Size and alignment of a type in Rock's memory (g++, x86-64) [B]. */
struct Extent {
    size_t size = 0;
    size_t align = 1;

    static constexpr size_t aligned(size_t offset, size_t align) { return (offset + align - 1) / align * align; }
    /** Appends a field and returns its offset. */
    constexpr size_t append(Extent field) {
        const size_t offset = aligned(size, field.align);
        size = offset + field.size;
        align = align > field.align ? align : field.align;
        return offset;
    }
    /** Returns the size with the padding up to the next element of an array. */
    constexpr size_t stride() const { return aligned(size, align); }
};

template <class T>
Extent getExtent();

template <types::Described T>
Extent extentOfFields() {
    Extent extent;
    forEachField<T>([&]<class F>(const types::Field&, F&) { extent.append(getExtent<F>()); });
    extent.size = extent.stride();
    return extent;
}

template <class T>
Extent getExtent() {
    if constexpr (Text<T>)
        return {32, 8};
    else if constexpr (Vector<T>)
        return {24, 8};
    else if constexpr (Matrix<T> || Quaternion<T>)
        return {sizeof(T), 8};
    else if constexpr (types::Described<T>) {
        static const Extent extent = extentOfFields<T>();
        return extent;
    } else
        return {sizeof(T), alignof(T)};
}

/** Returns a type's name as written in a registry. */
std::string xmlEscaped(const std::string& name);

/** The XML nodes of a registry: each type once, preceded by the types that it needs. */
class RegistryXml {
public:
    template <class T>
    void add() {
        const std::string name = typelibName<T>();
        if (knows(name)) return;
        if constexpr (Numeric<T>)
            addNumeric(name, std::is_floating_point_v<T> ? "float" : category<T>(), sizeof(T));
        else if constexpr (Text<T>)
            addContainer<int8_t>(name, "/std/string", 32);
        else if constexpr (Vector<T>)
            addContainer<typename T::value_type>(name, "/std/vector", 24);
        else if constexpr (Matrix<T>) {
            add<double>();
            const std::string type = "/double[" + std::to_string(sizeof(T) / sizeof(double)) + "]";
            addCompound(name, sizeof(T), {{"data", type, 0, false}});
        } else if constexpr (Quaternion<T>) {
            add<double>();
            addCompound(name, sizeof(T), {{"im", "/double[3]", 0, false}, {"re", "/double", 24, false}});
        } else if constexpr (std::is_enum_v<T>)
            addEnum(name, types::EnumTable<T>::symbols);
        else
            addDescribed<T>(name);
    }
    /** Returns the whole document. */
    std::string text() const;

private:
    struct Member {
        std::string name, type;
        size_t offset;
        bool logical_time;  ///< Rock's tools sort by the field with this role.
    };

    template <class T>
    static const char* category() {
        return std::is_signed_v<T> ? "sint" : "uint";
    }
    template <class Element>
    void addContainer(const std::string& name, const char* kind, size_t size) {
        add<Element>();
        addContainerNode(name, kind, size, typelibName<Element>());
    }
    template <class T>
    void addDescribed(const std::string& name) {
        std::vector<Member> members;
        Extent extent;
        forEachField<T>([&]<class F>(const types::Field& field, F&) {
            add<F>();
            const bool is_stamp = std::is_same_v<F, types::Time> && std::string_view(field.name) == "time";
            members.push_back({field.name, typelibName<F>(), extent.append(getExtent<F>()), is_stamp});
        });
        addCompound(name, extent.stride(), members);
    }
    bool knows(const std::string& name) const;
    void addNumeric(const std::string& name, const char* category, size_t size);
    void addContainerNode(const std::string& name, const char* kind, size_t size, const std::string& element);
    void addCompound(const std::string& name, size_t size, const std::vector<Member>& members);
    void addEnum(const std::string& name, std::span<const types::EnumSymbol> symbols);

    std::vector<std::pair<std::string, std::string>> nodes_;  ///< Name and XML.
};

/** Returns the registry that a stream of T declares. */
template <class T>
std::string makeRegistry() {
    RegistryXml registry;
    registry.add<T>();
    return registry.text();
}

}  // namespace insonify::log::pocolog
