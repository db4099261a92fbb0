#include "components/framework/Port.hpp"

#include "components/framework/Activity.hpp"

namespace insonify::framework {

void InputPortBase::signal() const {
    if (triggers_) owner().activity().trigger();
}

}  // namespace insonify::framework
