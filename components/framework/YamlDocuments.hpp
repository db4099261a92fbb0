#pragma once
#include <string>

namespace insonify::framework {

/** Throws YAML::Exception where yaml-cpp would find documents without end: at what cannot begin a value, such as a
 *  comma, it makes an empty one and stays where it is. */
void checkDocuments(const std::string& text);

}  // namespace insonify::framework
