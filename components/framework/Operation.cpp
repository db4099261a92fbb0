#include "components/framework/Operation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "components/framework/config/ConfigReader.hpp"

namespace insonify::framework {

void OperationBase::requireCount(const std::vector<std::string>& arguments, size_t taken) const {
    if (arguments.size() != taken)
        throw types::ConfigError("", name_, fmt::format("has {} arguments, takes {}", arguments.size(), signature()));
}

std::string OperationBase::makeSignature(const ValueType* result, const std::vector<const ValueType*>& arguments) {
    std::vector<std::string> names;
    for (const ValueType* argument : arguments) names.push_back(argument->name());
    return fmt::format("{}({})", result ? result->name() : "void", fmt::join(names, ", "));
}

void OperationBase::read(const std::vector<std::string>& texts, const std::vector<const ValueType*>& types,
                         const std::vector<void*>& values) const {
    ConfigReader reader("");
    for (size_t i = 0; i < texts.size(); ++i)
        reader.readText(texts[i], fmt::format("{}[{}]", name_, i), *types[i], values[i]);
    if (!reader.diagnostics().empty()) throw types::ConfigError(reader.diagnostics());
}

}  // namespace insonify::framework
