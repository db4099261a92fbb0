#pragma once
#include "components/output/tasks/PictureConfig.hpp"
#include "types/samples/Image.hpp"
#include "types/samples/Sonar.hpp"

namespace insonify::output {

/** Makes pictures from a stream of pings. */
class Painter {
public:
    virtual ~Painter() = default;
    /** @param picture becomes a BGR image, 8 bits a channel, with the ping's time; its memory is reused */
    virtual void paint(const types::Sonar& ping, types::Image& picture) = 0;
    /** Takes a ping for which no picture is made. */
    virtual void skip(const types::Sonar& /*ping*/) {}
};

}  // namespace insonify::output
