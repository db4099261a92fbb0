#include "tests/support/Paths.hpp"

namespace insonify::test {

const char source_dir[] = INSONIFY_SOURCE_DIR;
const char build_dir[] = INSONIFY_BUILD_DIR;
const char bin_dir[] = INSONIFY_BUILD_DIR "/bin";
const char shared_data[] = INSONIFY_SHARED_DATA;

}  // namespace insonify::test
