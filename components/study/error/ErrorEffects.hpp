#pragma once
#include "components/study/StudyScene.hpp"

namespace insonify::study {

/** Effects that a study of the error adds to a plain scene, one at a time. */
enum class Effect { PatternAndPulse, Seabed, Volume, Multipath, Coherent };
inline constexpr Effect effects[] = {Effect::PatternAndPulse, Effect::Seabed, Effect::Volume, Effect::Multipath,
                                     Effect::Coherent};

/** Returns a scene with one effect. Its name is the plain scene's, followed by "_pattern_and_pulse", "_seabed",
 *  "_volume", "_multipath" or "_coherent"; its reference must be computed.
 *
 *  Pattern and pulse have the proportions of deploy/harbour_recording.yml: a Taylor beam of -25 dB, 4 beams wide,
 *  transmitted slightly wider than the fan, and a chirp, weighted by Hann, whose c / 2B is 0.6 bins. Seabeds follow
 *  APL-UW TR 9407 at 100 kHz, with medium sand if a scene has none. Water scatters -50 dB re 1/m. The surface is the
 *  scene's, or 3 m above the sonar. Coherent speckle adds neither pattern nor pulse. */
StudyScene withEffect(const StudyScene& plain, Effect effect);

}  // namespace insonify::study
