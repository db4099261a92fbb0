#pragma once
#include <cstddef>
#include <cstdint>

#include "components/python/Handle.hpp"

namespace insonify::python {

/** What insonify/native.py calls, the same for every version of Python: handles, arrays and JSON. What gives a handle
 * or a text gives null on errors, and then insonify_error has the reason. */
extern "C" {

/** What went wrong in this thread's last call: `{kind, message, diagnostics}`, where kind is an exception of Python's
 * or ConfigError. Good until the thread's next call, as are all texts. */
const char* insonify_error();
void insonify_free(Handle* handle);
/** A handle's facts, as JSON. */
const char* insonify_facts(const Handle* handle);
/** Fills in the first `room` of a handle's arrays, which stay as long as it does, and gives their number. */
size_t insonify_arrays(const Handle* handle, Array* arrays, size_t room);

/** @param period [s]; null: that of the poses. Its facts: `{poses, pings, period, time}`. */
Handle* insonify_simulation(const char* deployment, uint64_t seed, const char* const* overrides, size_t override_count,
                            int truth, const double* period);
/** Steps with poses given at `ports`, seven numbers each: x, y, z [m] and a quaternion w, x, y, z. Puts a sample into
 *  each of `pings`, as many as the facts name; null where none was made.
 *  @param time [s]; null: that of the facts.
 *  @return 0; -1 on errors. */
int insonify_step(Handle* simulation, const char* const* ports, const double* poses, size_t port_count,
                  const double* time, Handle** pings);
/** @param seed null: the same. @return 0; -1 on errors. */
int insonify_reset(Handle* simulation, const uint64_t* seed);
/** Several simulations of one deployment on one scene, of one vehicle and one sonar. Its facts: `{poses, pings, period,
 * seeds}`. */
Handle* insonify_batch(const char* deployment, uint64_t seed, const char* const* overrides, size_t override_count,
                       int truth, const double* period, size_t count);
/** Steps all with seven numbers each, as insonify_step takes them. The pings as one sample: `bins` [simulations, beams,
 *  bins], `bearings`, `ranges`, `times` [s], and the truth by its names where it was asked for. */
Handle* insonify_batch_step(Handle* batch, const double* poses);
/** @param which numbers of simulations; @param seeds one for each, not 0; null: the same. @return 0; -1 on errors. */
int insonify_batch_reset(Handle* batch, const size_t* which, const uint64_t* seeds, size_t count);
/** A ping painted as a fan: a sample with the array `pixels`. @param reference_db null: none. */
Handle* insonify_fan(const Handle* ping, uint32_t width, double dynamic_range_db, const double* reference_db,
                     const char* colour_map, const char* scale, int code_bits);

/** Its facts: a list of `{name, type, metadata}`; the arrays are the times [s] of each of these streams. Threads that
 * read samples of it wait for each other. */
Handle* insonify_log(const char* file);
Handle* insonify_sample(Handle* log, size_t stream, size_t index);
}

}  // namespace insonify::python
