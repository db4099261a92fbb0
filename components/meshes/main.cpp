// insonify-read-mesh: reads one mesh file for the insonify library, which starts it as a separate process. It writes
// its reply to file descriptor 3.
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "components/meshes/AssimpFile.hpp"

using namespace insonify::meshes;

#ifdef __SANITIZE_ADDRESS__
/** The address sanitizer reserves unlimited address space, so it has to limit memory itself. */
extern "C" const char* __asan_default_options() { return "max_allocation_size_mb=1024:hard_rss_limit_mb=2048"; }
#endif

namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr bool limits_memory = false;
#else
constexpr bool limits_memory = true;
#endif

/** Lowers a limit; a lower limit stays. */
void limit(__rlimit_resource what, rlim_t maximum, rlim_t at_last) {
    rlimit limits{};
    getrlimit(what, &limits);
    limits.rlim_max = std::min(limits.rlim_max, at_last);
    limits.rlim_cur = std::min({limits.rlim_cur, maximum, limits.rlim_max});
    setrlimit(what, &limits);
}

void limitAll(unsigned processor_s, unsigned wall_s, rlim_t memory) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    limit(RLIMIT_CORE, 0, 0);
    limit(RLIMIT_CPU, processor_s, processor_s + 1);
    limit(RLIMIT_FSIZE, memory, memory);
    if (limits_memory) limit(RLIMIT_AS, memory, memory);
    alarm(wall_s);
}

MeshReply read(const char* file, MeshAxes axes) try {
    return {"", readByAssimp(file, axes)};
} catch (const std::bad_alloc&) {
    return {"needs more memory than a file of its size may take", {}};
} catch (const std::exception& failure) {
    return {failure.what(), {}};
}

}  // namespace

int main(int argc, char** argv) {
    std::FILE* reply = argc == 6 ? fdopen(mesh_reply_descriptor, "wb") : nullptr;
    if (!reply) {
        std::fputs("insonify-read-mesh: reads mesh files for insonify, which starts it\n", stderr);
        return 2;
    }
    limitAll(static_cast<unsigned>(std::atoi(argv[3])), static_cast<unsigned>(std::atoi(argv[4])),
             std::strtoull(argv[5], nullptr, 10));
    const MeshAxes axes = *argv[2] == 'z' ? MeshAxes::ZUp : MeshAxes::AsStored;
    _exit(writeReply(read(argv[1], axes), reply) ? 0 : 3);  // skips cleanup, which could crash as well
}
