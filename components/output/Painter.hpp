#pragma once
#include "components/output/PictureConfig.hpp"
#include "types/Image.hpp"
#include "types/Sonar.hpp"

namespace insonify::output {

/** Makes pictures of a stream of pings. */
class Painter {
public:
    virtual ~Painter() = default;
    /** @param picture becomes a BGR image, 8 bits a channel, with the ping's time. Its memory is used again. */
    virtual void paint(const types::Sonar& ping, types::Image& picture) = 0;
    /** Takes note of a ping of which no picture is wanted. */
    virtual void skip(const types::Sonar& /*ping*/) {}
};

}  // namespace insonify::output
