#pragma once

/** Embeds a file in the program, byte for byte, between SYMBOL_begin and SYMBOL_end, so that an installed program needs
 *  no path to it. By assembler code, which the link-time optimiser does not see: compile with -fno-lto.
 *  @param file its path, a string literal */
#define INSONIFY_EMBED(symbol, file)                                                               \
    __asm__(".pushsection .rodata\n.balign 16\n" #symbol "_begin:\n.incbin \"" file "\"\n" #symbol \
            "_end:\n.byte 0\n.popsection\n");                                                      \
    extern "C" const char symbol##_begin[], symbol##_end[];
