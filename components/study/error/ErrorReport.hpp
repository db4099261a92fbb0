#pragma once
#include <string>

#include "components/study/error/ErrorAnalysis.hpp"

namespace insonify::study {

/** Errors for which times are reported [1]. */
inline constexpr double goals[] = {0.1, 0.01, 0.001};
/** Below this multiple of its own error, a reference adds more than 5 % to the measured error [1]. */
inline constexpr double blurred = 3;

/** Returns tables in Markdown: references, times to an error, chosen qualities, claims, every point. */
std::string sheetOf(const ErrorResult& result);

}  // namespace insonify::study
