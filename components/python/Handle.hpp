#pragma once
#include <cstdint>
#include <vector>

#include "components/command/Json.hpp"

namespace insonify::python {

/** Numbers that belong to a handle, row by row. */
struct Array {
    const char* name;
    const char* type;  ///< As numpy writes it: "f4".
    const void* numbers;
    uint64_t shape[3];
    uint32_t dimensions;
};

/** What Python holds of a thing: facts and arrays. */
class Handle {
public:
    virtual ~Handle() = default;
    virtual command::Json facts() const = 0;
    virtual std::vector<Array> arrays() const { return {}; }
};

}  // namespace insonify::python
