// The component library worlds: `insonify scene make`, and sweeps that name recipes.
#include "components/loader/Interface.hpp"
#include "components/worlds/Generator.hpp"

INSONIFY_COMPONENT_LIBRARY;

extern "C" void insonify_make_scene(const std::vector<std::string>& options) { insonify::worlds::generate(options); }

extern "C" void insonify_generator_digest(std::string& digest) { digest = insonify::worlds::generatorDigest(); }
