#pragma once
#include "components/study/StudyScene.hpp"

namespace insonify::study {

/** What a study of the error adds to a plain scene, each alone. */
enum class Effect { PatternAndPulse, Seabed, Volume, Multipath, Coherent };
inline constexpr Effect effects[] = {Effect::PatternAndPulse, Effect::Seabed, Effect::Volume, Effect::Multipath,
                                     Effect::Coherent};

/** A scene with one effect; its name is the plain one's with "_pattern_and_pulse", "_seabed", "_volume", "_multipath"
 *  or "_coherent" behind it, its reference has to be computed.
 *
 *  Pattern and pulse have the proportions of deploy/harbour_recording.yml: a Taylor beam of -25 dB, 4 beams wide, sent
 *  over a little more than the fan, and a chirp, weighted by Hann, whose c / 2B is 0.6 bins. Seabeds follow APL-UW TR
 *  9407 at 100 kHz, medium sand where a scene has none. Water scatters -50 dB re 1/m. The surface is the scene's, or
 *  3 m above the sonar. Coherent speckle adds neither pattern nor pulse. */
StudyScene withEffect(const StudyScene& plain, Effect effect);

}  // namespace insonify::study
