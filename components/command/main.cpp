#include <malloc.h>

#include <insonify_commit.hpp>  // made by the build

#include "components/command/CommandLine.hpp"

namespace {

/** Mesa's software renderer allocates and frees megabytes for each ping. Kept in the process, this memory need not be
 *  mapped and cleared by the kernel again. */
void keepFreedMemory() {
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the max that glibc accepts [bytes]
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
}

}  // namespace

int main(int argc, char** argv) {
    keepFreedMemory();
    return insonify::command::runCommandLine(argc, argv, INSONIFY_COMMIT);
}
