#pragma once
#include <cstdint>
#include <vector>

#include "components/console/Json.hpp"

namespace insonify::python {

/** Numbers owned by a handle, row by row. */
struct Array {
    const char* name;
    const char* type;  ///< In numpy's notation: "f4".
    const void* numbers;
    uint64_t shape[3];
    uint32_t dimensions;
};

/** An object held by Python: facts and arrays. */
class Handle {
public:
    virtual ~Handle() = default;
    virtual console::Json facts() const = 0;
    virtual std::vector<Array> arrays() const { return {}; }
};

}  // namespace insonify::python
