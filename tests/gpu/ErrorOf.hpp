#pragma once
#include <string>

#include "components/gpu/EglContext.hpp"

namespace insonify::gpu {

/** What GlError says when `job` throws one; empty when it does not. */
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
