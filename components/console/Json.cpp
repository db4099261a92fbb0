#include "components/console/Json.hpp"

#include <fmt/core.h>

#include <fstream>
#include <stdexcept>

#include "components/console/Console.hpp"

namespace insonify::console {

std::string text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace); }

void print(const Json& json) { printResult("{}\n", text(json)); }

void write(const Json& json, const std::string& file) {
    std::ofstream stream(file);
    stream << text(json) << '\n';
    if (!stream.flush()) throw std::runtime_error(fmt::format("{}: cannot be written", file));
}

}  // namespace insonify::console
