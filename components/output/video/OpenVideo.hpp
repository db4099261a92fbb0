#pragma once
#include "components/output/VideoEncoder.hpp"

namespace insonify::output {

/** What libinsonify_video.so is asked for: see openVideo. The caller owns it. */
extern "C" VideoEncoder* insonify_open_video(const char* file, double rate, int width, int height);

}  // namespace insonify::output
