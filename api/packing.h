/* packing.h - zlib and zstd with memory from mesh/mem.h: what pack.c and unpack.c share.
 *
 * That of zstd is lent by functions its header keeps for ZSTD_STATIC_LINKING_ONLY. They are
 * exported by the shared library too; without them what a client makes the server hold would be
 * counted by nobody and bounded by no budget. */
#ifndef HE_API_PACKING_H
#define HE_API_PACKING_H

#define ZSTD_STATIC_LINKING_ONLY
#include <zlib.h>
#include <zstd.h>
#include <zstd_errors.h>

/* Both fill what the libraries ask for. */
void api_packing_zlib(z_stream *stream);
ZSTD_customMem api_packing_zstd(void);

#endif
