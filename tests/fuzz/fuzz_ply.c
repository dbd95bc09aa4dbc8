/* The reader of PLY files: reader.h says what must hold. */
#include "fuzz/fuzz.h"
#include "fuzz/reader.h"

void fuzz_one(const uint8_t *bytes, size_t size)
{
    fuzz_reader("ply", bytes, size);
}
