#pragma once
#include <exception>
#include <string>

namespace insonify::types {

/** What an exception tells a user: its own text, or a sentence of ours where that is only the name of a function of the
 *  standard library ("vector::_M_range_check", "stoi") or std::bad_alloc. */
std::string reasonOf(const std::exception& failure);

}  // namespace insonify::types
