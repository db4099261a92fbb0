#include <malloc.h>

#include "components/deployer/CommandLine.hpp"

namespace {

/** Mesa's software renderer takes megabytes for each ping and gives them back: kept in the process, they need not be
 *  handed out and cleared by the kernel again. */
void keepFreedMemory() {
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the largest that glibc takes [bytes]
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
}

}  // namespace

int main(int argc, char** argv) {
    keepFreedMemory();
    return insonify::deployer::runCommandLine(argc, argv);
}
