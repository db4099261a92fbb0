"""Makes sea floors with things on them as glTF: `insonify scene make`."""
