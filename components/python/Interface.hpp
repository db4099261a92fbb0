#pragma once
#include <cstddef>
#include <cstdint>

#include "components/python/Samples.hpp"

namespace insonify::python {

/** The C interface that insonify/native.py calls, the same for every version of Python: handles, arrays and JSON. A
 *  function that returns a handle or a text returns null on errors; then insonify_error has the reason. */
extern "C" {

/** Returns the error of this thread's last call: `{kind, message, diagnostics}`, where kind is an exception of Python's
 *  or ConfigError. Valid until the thread's next call, as are all texts. */
const char* insonify_error();
/** Frees a handle; a simulation of the parent is left as it is in a forked child, which may not use it either:
 *  RuntimeError. */
void insonify_free(Handle* handle);
/** Returns the version, that of `insonify --version`. */
const char* insonify_version();
/** Returns a handle's facts as JSON. */
const char* insonify_facts(const Handle* handle);
/** Fills in the first `room` of a handle's arrays, which are valid as long as the handle, and returns their number;
 *  SIZE_MAX: failed. */
size_t insonify_arrays(const Handle* handle, Array* arrays, size_t room);

/** Makes a simulation. Its facts: `{poses, pings, period, notices: [{text, is_warning}]}`.
 *  @param period [s]; null: that of the poses */
Handle* insonify_simulation(const char* deployment, uint64_t seed, const char* const* overrides, size_t override_count,
                            int truth, const double* period);
/** Steps with poses for `ports`, seven numbers each: x, y, z [m] and a quaternion w, x, y, z. Writes a sample, or null
 *  if no ping was made, to each of `pings`; the facts list the pings.
 *  @param time [s]; null: that of the facts.
 *  @return 0; -1 on errors. */
int insonify_step(Handle* simulation, const char* const* ports, const double* poses, size_t port_count,
                  const double* time, Handle** pings);
/** Returns the default time of a simulation's next step [s]. On any thread, also while another one steps. */
double insonify_time(const Handle* simulation);
/** Changes properties of a simulation or of all simulations of a batch: "task.property=value" each, all or none. */
int insonify_set(Handle* stepped, const char* const* assignments, size_t count);
/** Returns what a simulation, or the simulations of a batch, have warned of since the last call: a list of texts. */
const char* insonify_warnings(Handle* stepped);
/** Resets a simulation.
 *  @param seed null: the same.
 *  @return 0; -1 on errors. */
int insonify_reset(Handle* simulation, const uint64_t* seed);
/** Makes several simulations of one deployment on one scene, with one vehicle and one sonar. Its facts: `{poses, pings,
 *  period, seeds}`. */
Handle* insonify_batch(const char* deployment, uint64_t seed, const char* const* overrides, size_t override_count,
                       int truth, const double* period, size_t count);
/** Steps all simulations with seven numbers each, as for insonify_step(). Returns the pings as one sample: `bins`
 *  [simulations, beams, bins], `bearings`, `ranges`, `times` [s], and the truth by its names if it was requested. */
Handle* insonify_batch_step(Handle* batch, const double* poses);
/** Resets simulations of a batch.
 *  @param which numbers of simulations
 *  @param seeds one for each, not 0; null: the same.
 *  @return 0; -1 on errors. */
int insonify_batch_reset(Handle* batch, const size_t* which, const uint64_t* seeds, size_t count);
/** Renders a ping as a fan: a sample with the array `pixels`.
 *  @param reference_db null: none. */
Handle* insonify_fan(const Handle* ping, uint32_t width, double dynamic_range_db, const double* reference_db,
                     const char* colour_map, const char* scale, int code_bits);

/** Opens a log. Its facts: a list of `{name, type, metadata}`; the arrays are the times [s] of each of these streams.
 *  Threads that read its samples wait for each other. */
Handle* insonify_log(const char* file);
Handle* insonify_sample(Handle* log, size_t stream, size_t index);
}

}  // namespace insonify::python
