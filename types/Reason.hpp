#pragma once
#include <exception>
#include <string>

namespace insonify::types {

/** Returns the text of an exception for users. Texts that are only the name of a function of the standard library
 *  ("vector::_M_range_check", "stoi") and std::bad_alloc are replaced by a sentence. */
std::string reasonOf(const std::exception& failure);

/** Returns ": Permission denied" for this number of the system, to end a message on a file, and otherwise nothing:
 *  other reasons are clear from the message. */
std::string permissionReason(int error_number);

}  // namespace insonify::types
