#pragma once
#include <string_view>

/** Embeds a file in the program, byte for byte, from SYMBOL_begin to SYMBOL_end, so that an installed program needs no
 *  path to it. By assembler code, which the link-time optimiser does not see: compile with -fno-lto.
 *  @param file its path, a string literal */
#define INSONIFY_EMBED(symbol, file)                                                               \
    __asm__(".pushsection .rodata\n.balign 16\n" #symbol "_begin:\n.incbin \"" file "\"\n" #symbol \
            "_end:\n.byte 0\n.popsection\n");                                                      \
    extern "C" const char symbol##_begin[], symbol##_end[];

namespace insonify::framework {

/** Returns an embedded file by its two symbols. */
inline std::string_view embedded(const char* begin, const char* end) {
    return {begin, static_cast<size_t>(end - begin)};
}

}  // namespace insonify::framework
