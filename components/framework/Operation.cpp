#include "components/framework/Operation.hpp"

namespace insonify::framework {

void OperationBase::requireCount(const std::vector<std::string>& arguments, size_t taken) const {
    if (arguments.size() != taken)
        throw types::ConfigError("", name_, fmt::format("has {} arguments, takes {}", arguments.size(), signature()));
}

}  // namespace insonify::framework
