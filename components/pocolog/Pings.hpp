#pragma once
#include "components/pocolog/Reader.hpp"
#include "types/Sonar.hpp"

namespace insonify::pocolog {

/** Whether the stream holds pings, or the beams or scans that are read as such. */
bool holdsPings(const Stream& stream);

/** Fills `ping` from a sample of such a stream; a time that the sample does not give is that of its block. Throws
 *  ConfigError for one that contradicts itself. */
void readPing(Reader& log, const SampleRef& at, types::Sonar& ping);

}  // namespace insonify::pocolog
