#pragma once
#include <string>

#include "components/gpu/EglContext.hpp"

namespace insonify::gpu {

/** Returns the text of a GlError from `job`; empty when it throws none. */
template <class Job>
std::string errorOf(const Job& job) {
    try {
        job();
    } catch (const GlError& error) {
        return error.what();
    }
    return {};
}

}  // namespace insonify::gpu
