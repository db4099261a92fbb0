// INSONIFY_CHECK in the product's build: this file is compiled without INSONIFY_CHECKS (CMakeLists.txt).
#include <gtest/gtest.h>

#include "types/Check.hpp"

#ifdef INSONIFY_CHECKS
#error "this file is to be compiled without checks"
#endif

namespace insonify::types {
namespace {

TEST(CheckOffTest, NothingIsEvaluated) {
    int evaluated = 0;
    const auto fails = [&] { return ++evaluated < 0; };
    INSONIFY_CHECK(fails());
    INSONIFY_CHECK(fails(), ++evaluated, "text");
    EXPECT_EQ(evaluated, 0);
}

/** Compiles only where the compiler removes the check: a call in it would not be constant. */
constexpr int afterCheck(int value) {
    INSONIFY_CHECK(value > 1000, value);
    return value;
}
static_assert(afterCheck(1) == 1);

}  // namespace
}  // namespace insonify::types
